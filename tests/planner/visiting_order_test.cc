// The same bits in any visiting order: serial against random, stage by stage and as whole plans.
#include <cstring>
#include <memory>

#include "planner/field/grid_planner.h"
#include "tests/planner/field_rig.h"
#include "tests/planner/shuffled_executor.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

template <class T>
bool same(const T* a, const T* b, std::int32_t n) {
  return std::memcmp(a, b, static_cast<std::size_t>(n) * sizeof(T)) == 0;
}

/// FNV-1a.
struct Digest {
  std::uint64_t value = 14695981039346656037ULL;
  void add(const void* bytes, std::size_t n) {
    const auto* byte = static_cast<const unsigned char*>(bytes);
    for (std::size_t k = 0; k < n; ++k) value = (value ^ byte[k]) * 1099511628211ULL;
  }
};

TestMap small_map(std::uint64_t seed) {
  TestMap map("small", 64);
  Random random(seed);
  for (int k = 0; k < 12; ++k) {
    const std::int32_t i = random.below(60), j = random.below(60);
    const std::int32_t w = 2 + random.below(8), h = 2 + random.below(8);
    map.box(i, j, i + w, j + h);
  }
  map.box(4, 4, 12, 12, 0), map.box(50, 50, 60, 60, 0);
  return map;
}

std::vector<Track> crowd() {
  std::vector<Track> tracks;
  Random random(17);
  for (std::uint32_t k = 1; k <= 6; ++k) {
    Track track;
    track.id = k;
    track.position_in_map = {6.4 * random.unit(), 6.4 * random.unit()};
    track.velocity_in_map = {random.unit() - 0.5, random.unit() - 0.5};
    track.covariance = {0.001, 0.0005, 0.01};
    track.radius_m = 0.1;
    tracks.push_back(track);
  }
  return tracks;
}

}  // namespace

TEST_CASE("clearance, start field, potential and index matrix do not depend on the visiting order") {
  FieldRig<> serial(64);
  FieldRig<ShuffledExecutor> shuffled(64);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const std::int32_t goal = serial.grid.at(55, 55), n = serial.grid.cells();
    serial.load(small_map(seed), 1.0F, goal);
    shuffled.load(small_map(seed), 1.0F, goal);
    CHECK(same(serial.arrays().clearance, shuffled.arrays().clearance, n));
    CHECK(same(serial.arrays().rate, shuffled.arrays().rate, n));
    CHECK(same(serial.arrays().cost, shuffled.arrays().cost, n));
    for (int tick = 0; tick < 2; ++tick) {
      const field::FieldQuality quality =
          serial.pass.solve(serial.grid, goal, tick > 0 ? field::From::kLast : field::From::kNothing, serial.psi);
      CHECK(
          shuffled.pass.solve(shuffled.grid, goal, tick > 0 ? field::From::kLast : field::From::kNothing, shuffled.psi)
              .pits == quality.pits);
      CHECK(quality.joined > 500);
      CHECK(same(serial.psi, shuffled.psi, n));
      CHECK(same(serial.arrays().index, shuffled.arrays().index, n));
    }
  }
}

TEST_CASE("whole plans, marks and bands do not depend on the visiting order, in either mode") {
  for (const PlanMode mode : {PlanMode::kPaper, PlanMode::kFull}) {
    PlannerConfig config;
    config.mode = mode;
    config.side_cells = config.max_side_cells = 64;
    config.inflation_m = 0.15;
    config.mover_margin_m = 0.1;
    field::GridPlanner<field::SerialExecutor> serial(config, std::make_unique<field::SerialExecutor>());
    field::GridPlanner<ShuffledExecutor> shuffled(config, std::make_unique<ShuffledExecutor>());
    const EvidenceMap map = evidence_of(small_map(3));
    std::vector<Track> tracks = crowd();
    PlanRequest request;
    request.map_from_robot = {0.83, 0.77, 0.6};
    request.goal_in_map = {5.52, 5.53};
    request.speed_mps = 0.6;
    request.still = &map;
    int planned = 0;
    for (int tick = 0; tick < 8; ++tick) {
      for (Track& track : tracks) track.position_in_map = track.position_in_map + track.velocity_in_map * 0.066;
      request.moving = tracks;
      serial.submit(request);
      shuffled.submit(request);
      const Plan& a = serial.collect();
      const Plan& b = shuffled.collect();
      REQUIRE(a.status == b.status);
      REQUIRE(a.path.size() == b.path.size());
      CHECK(same(serial.arrays().warp, shuffled.arrays().warp, 64 * 64));
      CHECK(same(serial.arrays().marks, shuffled.arrays().marks, 6));
      CHECK(same(serial.arrays().occupants, shuffled.arrays().occupants, 64 * 64));
      CHECK(same(a.path.data(), b.path.data(), static_cast<std::int32_t>(a.path.size())));
      CHECK(same(serial.view_field().psi.data(), shuffled.view_field().psi.data(), 64 * 64));
      if (a.status == PlanStatus::kOk) ++planned;
    }
    CHECK(planned > 0);
  }
}

TEST_CASE("a plan has the same bytes with every compiler, optimisation level and processor, and by 4, 8 or 16 lanes") {
  // The digest is what g++ 12, g++ 11 (-O3 for x86-64-v3 without fused instructions), clang 14 and aarch64 give; it
  // changes with the algorithm. A processor without so many lanes takes what it has.
  PlannerConfig config;
  config.side_cells = config.max_side_cells = 64;
  config.inflation_m = 0.15;
  config.mover_margin_m = 0.1;
  const EvidenceMap map = evidence_of(small_map(3));
  const std::vector<Track> tracks = crowd();
  PlanRequest request;
  request.map_from_robot = {0.83, 0.77, 0.6};
  request.goal_in_map = {5.52, 5.53};
  request.speed_mps = 0.6;
  request.still = &map;
  request.moving = tracks;
  for (const field::Lanes lanes : {field::Lanes::kFour, field::Lanes::kEight, field::Lanes::kSixteen}) {
    field::GridPlanner<field::SerialExecutor> planner(config, std::make_unique<field::SerialExecutor>(lanes));
    Digest digest;
    for (int tick = 0; tick < 4; ++tick) {
      planner.submit(request);
      const Plan& plan = planner.collect();
      REQUIRE(plan.status == PlanStatus::kOk);
      digest.add(plan.path.data(), plan.path.size() * sizeof(Vec2));
      digest.add(planner.view_field().psi.data(), planner.view_field().psi.size_bytes());
    }
    CHECK(digest.value == 0xaefc08d2157365deULL);
  }
}

TEST_CASE("the comparison can fail: sweeping in place depends on the order") {
  struct InPlace {
    std::int32_t side;
    float* x;
    void operator()(std::int32_t c) const {
      if (c > 0 && c < side - 1) x[c] = 0.5F * (x[c - 1] + x[c + 1]);
    }
  };
  field::SerialExecutor serial;
  ShuffledExecutor shuffled;
  float* a = serial.take<float>(64);
  float* b = shuffled.take<float>(64);
  a[0] = b[0] = 1.0F;
  serial.for_each(64, InPlace{64, a});
  shuffled.for_each(64, InPlace{64, b});
  CHECK_FALSE(same(a, b, 64));
}
