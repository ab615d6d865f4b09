// The time to go from poses: a wheelchair's, 0.75 m before its axle, 0.35 m behind and 0.325 m to either side.
#include "planner/cost_to_go/pose_field.h"

#include <algorithm>
#include <numeric>
#include <random>

#include "tests/motion/chair.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using tests::Chair;
using tests::WalledGround;

namespace {

const Footprint kChair = wheelchair().footprint;

/// A wall along x = 2.03 with a door about y = 0.
WalledGround door(double width_m) {
  return WalledGround().wall({2.03, -3.9}, {2.03, -0.5 * width_m}).wall({2.03, 0.5 * width_m}, {2.03, 3.9});
}

/// A corridor of 1.2 m along x, closed at x = 1 and open to the left beyond x = -2.
WalledGround dead_end() {
  return WalledGround()
      .wall({1.0, -0.6}, {1.0, 0.6})
      .wall({-3.9, -0.6}, {1.0, -0.6})
      .wall({-1.5, 0.6}, {1.0, 0.6})
      .wall({-1.5, 0.6}, {-1.5, 4.0});
}

Pose2 pose_of(const WayPose& pose) {
  return {static_cast<double>(pose.x), static_cast<double>(pose.y), static_cast<double>(pose.heading)};
}

double depth_of(Vec2 p, const WayPose& pose) {
  const Vec2 q = inverse(pose_of(pose)) * p;
  return std::min({kChair.front_m - q.x, q.x + kChair.rear_m, kChair.half_width_m - std::fabs(q.y)});
}

/// Costs of all poses by relaxing each from all its moves, in any order, until nothing changes; from those that are
/// what no move makes them: where the field was sown.
std::vector<std::uint16_t> settled_in_order(const PoseGuide& guide, std::uint32_t seed) {
  std::vector<std::uint16_t> costs(PoseLattice::kPoses, PoseGuide::kNoWay);
  std::vector<std::int32_t> order;
  const auto least_after = [&](std::int32_t pose, const std::uint16_t* of) {
    std::uint32_t least = PoseGuide::kNoWay;
    const auto h = static_cast<std::size_t>(PoseLattice::heading_of(pose));
    for (std::int32_t m = 0; m < guide.moves->count[h]; ++m) {
      const PoseGuide::Step step = guide.step(pose, guide.moves->from[h][static_cast<std::size_t>(m)]);
      if (step.cost < PoseGuide::kNoWay && of[step.to] < PoseGuide::kNoWay)
        least = std::min(least, of[step.to] + step.cost);
    }
    return least;
  };
  for (std::int32_t pose = 0; pose < PoseLattice::kPoses; ++pose) {
    if (guide.rate[pose] == 0) continue;
    order.push_back(pose);
    const auto n = static_cast<std::size_t>(pose);
    if (guide.cost[pose] < least_after(pose, guide.cost)) costs[n] = guide.cost[pose];
  }
  std::mt19937 engine(seed);
  for (bool changed = true; changed;) {
    changed = false;
    std::shuffle(order.begin(), order.end(), engine);
    for (const std::int32_t pose : order) {
      const std::uint32_t least = least_after(pose, costs.data());
      if (least >= costs[static_cast<std::size_t>(pose)]) continue;
      costs[static_cast<std::size_t>(pose)] = static_cast<std::uint16_t>(least);
      changed = true;
    }
  }
  return costs;
}

}  // namespace

TEST_CASE("in the open a pose costs its way, and facing elsewhere costs the turn") {
  const WalledGround ground;
  Chair chair(ground);
  REQUIRE(chair.from({0.0, 0.0, kPi}, {2.0, 0.0}).known);
  // It arrives 0.15 m before the goal: 1.85 m at 0.6 m/s, in cells of 0.1 m.
  CHECK(chair.seconds(0.0, 0.0, 0.0) == Approx(3.1).margin(0.2));
  // On the spot half a turn takes pi / 0.5 = 6.3 s and 24 steps of 0.03 s; no more than that, and no less than 180
  // degrees at 1 rad/s while it drives.
  CHECK(chair.seconds(0.0, 0.0, kPi) < 3.1 + 7.1);
  CHECK(chair.seconds(0.0, 0.0, kPi) > 3.1 + 2.0);
  CHECK(chair.seconds(0.0, 0.0, 1.0) == Approx(chair.seconds(0.0, 0.0, -1.0)).margin(0.15));
  CHECK(chair.seconds(0.0, 0.0, 0.5) < chair.seconds(0.0, 0.0, 1.5));
}

TEST_CASE("a goal with a heading is reached when that is, and turned for on the spot where there is room") {
  const WalledGround ground;
  Chair chair(ground);
  REQUIRE(chair.from({0.0, 0.0, 0.0}, {0.05, 0.05}, kPi / 2.0).known);
  CHECK(chair.seconds(0.05, 0.05, kPi / 2.0) < 0.2F);
  // On the spot a quarter takes pi / 2 / 0.5 = 3.14 s and 12 steps of 0.03 s; an arc within the goal's tolerance may do
  // a part of it faster, at 1 rad/s at most.
  for (const double heading : {0.0, kPi}) {
    CHECK(chair.seconds(0.05, 0.05, heading) <= 3.51F);
    CHECK(chair.seconds(0.05, 0.05, heading) > 2.0F);
  }
  CHECK(chair.seconds(0.05, 0.05, 0.0) == Approx(chair.seconds(0.05, 0.05, kPi)).margin(0.05));
}

TEST_CASE("a body passes a door that is narrower than it is long, lengthwise, and none narrower than its room") {
  const WalledGround wide = door(0.90), narrow = door(0.66);
  Chair chair(wide);
  for (const double y : {-1.0, 0.0, 1.0}) {
    for (const double heading : {-1.0, 0.0, 1.0, 3.0}) {
      const Pose2 robot{0.6, y, heading};
      REQUIRE(chair.from(robot, {3.2, 0.1}).known);
      const PoseWay way = chair.way(robot);
      CHECK(distance(pose_of(way.poses[static_cast<std::size_t>(way.count - 1)]).position(), {3.2, 0.1}) < 0.25);
      for (std::int32_t k = 0; k < way.count; ++k) {
        CHECK(depth_of({2.03, 0.45}, way.poses[static_cast<std::size_t>(k)]) < -0.02);
        CHECK(depth_of({2.03, -0.45}, way.poses[static_cast<std::size_t>(k)]) < -0.02);
      }
    }
  }
  Chair refused(narrow);
  CHECK_FALSE(refused.from({0.6, 0.0, 0.0}, {3.2, 0.1}).known);
}

TEST_CASE("a door at any angle is passed") {
  int known = 0;
  for (int k = 0; k < 24; ++k) {
    const double angle = 2.0 * kPi * k / 24.0 + 0.04;
    const Vec2 along = direction(angle + kPi / 2.0), middle = direction(angle) * 1.4;
    const WalledGround ground = WalledGround()
                                    .wall(middle + along * 0.45, middle + along * 2.2)
                                    .wall(middle - along * 0.45, middle - along * 2.2);
    Chair chair(ground);
    const Vec2 goal = direction(angle) * 2.6;
    chair.from({0.0, 0.0, angle + 1.5}, goal);
    known += chair.poses.known && chair.seconds(0.0, 0.0, angle) < 9.0F ? 1 : 0;  // round the wall it takes longer
  }
  CHECK(known == 24);
}

TEST_CASE("out of a dead end that it cannot turn in a body backs") {
  const WalledGround ground = dead_end();
  Chair chair(ground);
  REQUIRE(chair.from({0.0, 0.0, 0.0}, {-2.6, 2.0}).known);
  const PoseWay way = chair.way({0.0, 0.0, 0.0});
  for (std::size_t k = 1; k < 5; ++k) CHECK(way.poses[k].gear == Gear::kBackward);
  // 1.5 m backward at 0.3 m/s at the least.
  CHECK(chair.seconds(0.0, 0.0, 0.0) > 5.0F);
}

TEST_CASE("the costs are one fixed point, in whatever order they are settled") {
  // A room of 3.2 m by 2.4 m with a pillar: so few poses that each may be relaxed again and again.
  const WalledGround ground = WalledGround()
                                  .wall({-1.2, -1.2}, {2.0, -1.2})
                                  .wall({2.0, -1.2}, {2.0, 1.2})
                                  .wall({2.0, 1.2}, {-1.2, 1.2})
                                  .wall({-1.2, 1.2}, {-1.2, -1.2})
                                  .wall({0.5, 0.9}, {0.5, 0.92});
  Chair chair(ground);
  REQUIRE(chair.from({-0.4, -0.5, 1.0}, {1.0, 0.2}, 0.5).known);
  std::vector<std::uint16_t> once = settled_in_order(chair.poses, 1);
  CHECK(once == settled_in_order(chair.poses, 2));
  const std::vector<std::uint16_t>& settled = chair.memory.cost;
  std::uint16_t dearest = 0;
  std::int64_t known = 0;
  for (const std::uint16_t cost : settled) {
    if (cost == PoseGuide::kNoWay) continue;
    dearest = std::max(dearest, cost), ++known;
  }
  // Poses dearer than the robot's are left out where costs are settled in order.
  for (std::uint16_t& cost : once) cost = cost > dearest ? PoseGuide::kNoWay : cost;
  CHECK(once == settled);
  CHECK(known > 1000);
}

TEST_CASE("a field settled after another has the bytes of a fresh one, and asks nothing of the heap") {
  const WalledGround ground = door(0.90);
  Chair kept(ground), fresh(ground);
  kept.from({0.6, -1.0, 2.0}, {3.2, 0.1}, 1.0);
  const AllocationGuard guard;
  kept.from({0.9, 0.3, 0.1}, {3.0, 0.4});
  const auto calls = guard.calls();
  CHECK(calls == 0);
  fresh.from({0.9, 0.3, 0.1}, {3.0, 0.4});
  CHECK(kept.memory.cost == fresh.memory.cost);
}

TEST_CASE("a queue that is too small says so: then no way is known, and no cost is told") {
  const WalledGround ground = door(0.90);
  Chair full(ground), small(ground, nullptr, 2000);
  REQUIRE(full.from({0.6, -1.0, 2.0}, {3.2, 0.1}).known);
  CHECK_FALSE(small.from({0.6, -1.0, 2.0}, {3.2, 0.1}).known);
  CHECK(std::count(small.memory.cost.begin(), small.memory.cost.end(), PoseGuide::kNoWay) == PoseLattice::kPoses);
}

TEST_CASE("to a goal beyond the square the way leads out of it, with the time from there") {
  const WalledGround ground;
  Chair chair(ground);
  REQUIRE(chair.from({-2.0, 0.0, 0.0}, {5.0, 0.0}).known);
  CHECK(chair.seconds(-2.0, 0.0, 0.0) == Approx(7.0 / 0.6).margin(1.0));
  const PoseWay way = chair.way({-2.0, 0.0, 0.0});
  CHECK(way.poses[static_cast<std::size_t>(way.count - 1)].x > 0.7F);
}

TEST_CASE("past a pedestrian that stands the way is dear, and not closed") {
  const WalledGround ground = door(1.6);
  Chair chair(ground);
  chair.from({0.6, 0.0, 0.0}, {3.2, 0.0});
  const float free = chair.seconds(0.6, 0.0, 0.0);
  chair.standing.push_back({{2.03, 0.0}, 0.25});
  REQUIRE(chair.from({0.6, 0.0, 0.0}, {3.2, 0.0}).known);
  CHECK(chair.seconds(0.6, 0.0, 0.0) > free + 3.0F);
}

TEST_CASE("a way that soon turns or backs into what was never seen says so") {
  WalledGround ground = dead_end();
  for (int j = -6; j < 6; ++j) {
    for (int i = -40; i < -7; ++i) ground.forget({i, j});
  }
  Chair chair(ground);
  REQUIRE(chair.from({0.0, 0.0, 0.0}, {-2.6, 2.0}).known);
  CHECK(chair.poses.through_unseen);
  const WalledGround seen = dead_end();
  Chair other(seen);
  REQUIRE(other.from({0.0, 0.0, 0.0}, {-2.6, 2.0}).known);
  CHECK_FALSE(other.poses.through_unseen);
}
