// What is repaired has the bytes of what is computed from nothing, whatever has changed.
#include <algorithm>
#include <array>
#include <vector>

#include "planner/cost_to_go/guide_field.h"
#include "tests/planner/same_bytes.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

constexpr std::int32_t kSide = 64, kCells = kSide * kSide;

/// Discs and boxes that come, go and move in a room: from hardly any change to another map.
class ChangingRoom {
 public:
  explicit ChangingRoom(std::uint64_t seed) : random_(seed) {
    for (Disc& disc : discs_) place(disc);
  }
  TestMap next() {
    for (Disc& disc : discs_) {
      const std::int32_t what = random_.below(100);
      if (what < 5) place(disc);
      if (what >= 60) disc.x += random_.unit() - 0.5, disc.y += random_.unit() - 0.5;
    }
    if (random_.below(12) == 0) wall_ = random_.below(kSide);
    TestMap map("changing", kSide);
    map.box(wall_, 0, wall_ + 1, 40);
    for (std::int32_t c = 0; c < kCells; ++c) {
      for (const Disc& disc : discs_) {
        const double dx = c % kSide - disc.x, dy = c / kSide - disc.y;
        if (dx * dx + dy * dy <= disc.radius * disc.radius) map.wall[static_cast<std::size_t>(c)] = 1;
      }
    }
    map.box(2, 2, 8, 8, 0);  // room for a goal
    return map;
  }
  Random& random() { return random_; }

 private:
  struct Disc {
    double x, y, radius;
  };
  void place(Disc& disc) { disc = {kSide * random_.unit(), kSide * random_.unit(), 1.0 + 3.0 * random_.unit()}; }
  Random random_;
  std::array<Disc, 6> discs_{};
  std::int32_t wall_ = 30;
};

EvidenceMap seen(const TestMap& map, Random& random, std::int32_t unseen) {
  EvidenceMap evidence(128, 0.1, {3.2, 3.2});
  for (std::int32_t c = 0; c < kCells; ++c) {
    const CellIndex cell{c % kSide, c / kSide};
    const Vec2 at = evidence.centre_of(cell);
    if (map.wall[static_cast<std::size_t>(c)] != 0) {
      const double off = (c * 31 % 64 - 32) / 1000.0 + (random.below(200) == 0 ? 0.01 : 0.0);
      evidence.add_hit({at.x + off, at.y - off}, 40);
    } else if ((c / 8) % 16 != unseen) {
      evidence.add(cell, -30);
    }
  }
  return evidence;
}

}  // namespace

TEST_CASE("a repaired guide has the bytes of one from nothing: walls, bodies, robot, goal and window change") {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    ChangingRoom room(seed);
    Random& random = room.random();
    field::TimeToGoField kept(0.19, 0.3, kSide);
    field::TimeToGoField::Memory memories[] = {field::TimeToGoField::Memory(kSide),
                                               field::TimeToGoField::Memory(kSide)};
    EvidenceMap evidence = seen(room.next(), random, 3);
    Vec2 robot{5.4, 5.4};
    std::vector<MoverDisc> movers{{{2.0, 3.0}, 0.3}, {{4.0, 4.0}, 0.25}};
    std::vector<StandingPedestrian> standing;
    for (int tick = 0; tick < 40; ++tick) {
      if (random.below(4) == 0) evidence = seen(room.next(), random, random.below(20));
      robot = robot + Vec2{random.unit() - 0.6, random.unit() - 0.6} * 0.1;
      for (MoverDisc& mover : movers)
        mover.centre_in_map = mover.centre_in_map + Vec2{0.05, random.unit() * 0.1 - 0.05};
      if (standing.empty() || random.below(10) == 0)
        standing = {{movers[random.below(2) == 0 ? 0 : 1].centre_in_map, 0.25}};
      const Vec2 goal = tick % 13 == 12 ? Vec2{20.0, 1.0} : Vec2{0.45, 0.45};
      const field::Window window{{tick < 30 ? 0 : 16, 0}, kSide, 0.1};
      const PlanRequest request{.map_from_robot = {robot.x, robot.y, 0.0},
                                .goal_in_map = goal,
                                .speed_mps = tick % 7 == 0 ? 0.6 : 0.5,
                                .still = &evidence,
                                .standing = standing,
                                .masked = movers};
      field::TimeToGoField::Memory fresh(kSide);
      const Guide a = kept.settle(request, window, memories[tick % 2]);
      const Guide b = field::TimeToGoField(0.19, 0.3, kSide).settle(request, window, fresh);
      REQUIRE(a.through_unseen == b.through_unseen);
      REQUIRE(same(a.to_go_s, b.to_go_s, kCells));
      REQUIRE(same(a.surface, b.surface, kCells));
      REQUIRE(same(a.unseen, b.unseen, kCells));
    }
  }
}
