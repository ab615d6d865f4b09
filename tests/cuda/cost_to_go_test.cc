// The time to go over cells and over poses, on the emulated device: the processor's numbers, in whatever order blocks
// and threads run.
#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "cuda/cuda_cost_to_go.h"
#include "cuda/emulated/device.h"
#include "planner/cost_to_go/guide_field.h"
#include "tests/motion/chair.h"
#include "tests/planner/same_bytes.h"
#include "tests/planner/test_maps.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;
using emulated::device;
using emulated::Fault;
using tests::Chair;
using tests::WalledGround;

namespace {

/// A settler, and a device newly switched on under it.
struct Rig {
  explicit Rig(const emulated::Properties& properties)
      : powered((device().power_on(properties), true)), settler(0, std::chrono::seconds(30), 256) {}
  bool powered;
  CudaCostToGo settler;
};

/// Costs over poses whose rates are given by cell.
struct Given {
  explicit Given(std::uint16_t first) : cost(PoseLattice::kPoses, first) {
    for (std::size_t k = 0; k < of_room.size(); ++k) of_room[k] = static_cast<std::uint8_t>(k);
    PoseMoves moves;
    moves.draw(Chair::kSpeeds);
    back.turn_back(moves);
  }
  void rate_cell(std::int32_t i, std::int32_t j, std::uint8_t as) {
    nodes[static_cast<std::size_t>(j * Look::kPerCell * Look::kColumns + i)] = as;
  }
  [[nodiscard]] field::PoseCosts costs() {
    return {{nodes.data(), places.data(), &radius, 1, room.data(), shift.data()},
            {of_room.data(), 0, room.data(), nullptr, -1, rate.data()},
            {&back, rate.data()},
            -1,
            1024,
            cost.data()};
  }

  using Look = field::PoseLook;
  std::vector<std::uint16_t> cost;

 private:
  static constexpr std::size_t kPoses = PoseLattice::kPoses, kNodes = Look::kNodes;
  std::vector<std::uint8_t> nodes = std::vector<std::uint8_t>(kNodes * kNodes),
                            room = std::vector<std::uint8_t>(kPoses), rate = room;
  std::vector<std::int32_t> places =
      std::vector<std::int32_t>(PoseLattice::kHeadings * Look::kSides);  // of cell (0, 0)
  std::vector<std::int8_t> shift = std::vector<std::int8_t>(kPoses);
  std::array<std::uint8_t, 256> of_room{};
  std::uint8_t radius = 0;
  field::BackMoves back{};
};

/// Walls of a metre here and there, none of them about the origin.
WalledGround scattered(std::uint64_t seed) {
  WalledGround ground;
  Random random(seed);
  for (int k = 0; k < 14; ++k) {
    const Vec2 from{6.0 * random.unit() - 3.0, 6.0 * random.unit() - 3.0};
    if (norm(from) < 1.8) continue;
    ground.wall(from, from + direction(6.3 * random.unit()));
  }
  return ground;
}

/// Both settle the same request. Whether there is a way.
bool check_same(Chair& cpu, Chair& gpu, const Pose2& robot, Vec2 goal, double heading) {
  const PoseGuide& a = cpu.from(robot, goal, heading);
  const PoseGuide& b = gpu.from(robot, goal, heading);
  CHECK(same(cpu.guide.to_go_s, gpu.guide.to_go_s, cpu.guide.side * cpu.guide.side));
  CHECK(cpu.memory.room == gpu.memory.room);
  CHECK(cpu.memory.shift == gpu.memory.shift);
  CHECK(cpu.memory.rate == gpu.memory.rate);
  CHECK(cpu.memory.cost == gpu.memory.cost);
  CHECK(a.known == b.known);
  CHECK(a.through_unseen == b.through_unseen);
  return a.known;
}

}  // namespace

TEST_CASE("emulated: times from cells and from poses are the processor's on random grounds, in every order") {
  int known = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Rig rig({.guarded = true, .seed = seed});
    WalledGround ground = scattered(seed);
    for (int j = -30; seed % 2 == 0 && j < 30; ++j) {
      for (int i = 12; i < 40; ++i) ground.forget({i, j});
    }
    Chair cpu(ground), gpu(ground, &rig.settler);
    if (seed == 3) cpu.standing.push_back({{0.9, 0.4}, 0.25}), gpu.standing = cpu.standing;
    const Vec2 goal = direction(1.1 * static_cast<double>(seed)) * (seed % 2 == 0 ? 2.2 : 5.0);
    known += check_same(cpu, gpu, {0.0, 0.0, 0.7 * static_cast<double>(seed)}, goal, seed % 2 == 0 ? 1.0 : kAnyHeading);
    // The second is repaired from the first where the ground is the same.
    known += check_same(cpu, gpu, {0.1, 0.1, 0.2}, goal, kAnyHeading);
    CHECK(device().counts.launches >= 10);
  }
  CHECK(known >= 9);
}

TEST_CASE("emulated: a robot nowhere on the lattice, and costs up to the largest, are settled as far as numbers go") {
  Rig rig({.seed = 4});
  Given given(PoseGuide::kNoWay);
  for (std::int32_t i = 0; i < PoseLattice::kSide; ++i) given.rate_cell(i, 20, 255);  // a lane as dear as can be
  std::vector<std::uint16_t>& cost = given.cost;
  cost[static_cast<std::size_t>(PoseLattice::at(0, 20, 0))] = 60000;
  REQUIRE(rig.settler.settle(given.costs()));
  const auto near = static_cast<std::size_t>(PoseLattice::at(1, 20, 0)),
             far = static_cast<std::size_t>(PoseLattice::at(60, 20, 0));
  CHECK(cost[near] > 60000);
  CHECK(cost[near] < PoseGuide::kNoWay);
  CHECK(cost[far] == PoseGuide::kNoWay);
}

TEST_CASE("emulated: poses are settled in few steps, and hardly more of them than Dijkstra visits") {
  int most_steps = 0;
  double most_expanded = 0.0;
  for (std::uint64_t seed = 11; seed <= 30; ++seed) {
    CAPTURE(seed);
    Rig rig({.seed = seed});
    const WalledGround ground = scattered(seed);
    Chair gpu(ground, &rig.settler);
    static_cast<void>(gpu.from({0.0, 0.0, 0.7 * static_cast<double>(seed)},
                               direction(1.1 * static_cast<double>(seed)) * (seed % 2 == 0 ? 2.2 : 5.0)));
    const Piles::Told& told = rig.settler.told();
    CHECK(told.full == 0);
    const auto settled = std::count_if(gpu.memory.cost.begin(), gpu.memory.cost.end(),
                                       [](std::uint16_t cost) { return cost != PoseGuide::kNoWay; });
    most_steps = std::max(most_steps, told.steps);
    most_expanded = std::max(most_expanded, told.expanded / std::max(1.0, static_cast<double>(settled)));
  }
  std::printf("at most %d steps, %.2f times Dijkstra's expansions\n", most_steps, most_expanded);
  CHECK(most_steps <= 90);  // 80 wanted, 81 to 84 measured; 88 to 102 with spans of 96, 112, 160, 192
  CHECK(most_expanded <= 1.3);
}

TEST_CASE("emulated: more costs than a pile holds are settled by the processor") {
  Rig rig({.guarded = true, .seed = 7});
  Given given(100);
  for (std::int32_t j = 0; j < PoseLattice::kSide; ++j) {
    for (std::int32_t i = 0; i < PoseLattice::kSide; ++i) given.rate_cell(i, j, 8);
  }
  const std::vector<std::uint16_t> before = given.cost;
  CHECK_FALSE(rig.settler.settle(given.costs()));
  CHECK(given.cost == before);
  CHECK(std::string(rig.settler.failure()).empty());
}

TEST_CASE("emulated: a settler whose device fails says so, has written nothing, and its field is the processor's") {
  for (const Fault fault : {Fault::kRefused, Fault::kBroken}) {
    for (const int launch : {0, 1, 4}) {  // two over cells, four over poses
      Rig rig({.guarded = true, .seed = 2});
      const WalledGround ground = scattered(5);
      Chair cpu(ground), gpu(ground, &rig.settler);
      device().order(fault, launch);
      check_same(cpu, gpu, {0.0, 0.0, 0.3}, {2.0, 1.0}, 0.5);
      if (fault == Fault::kBroken) CHECK(std::string(rig.settler.failure()) == "the device failed");
    }
  }
  device().power_on();
}
