#include "planner/motion/near_returns.h"

#include <algorithm>
#include <cmath>

#include "firmware/safety/stop_zone.h"
#include "tests/safety/scans.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::motion;

namespace {

const RobotModel kRobot = p3dx();
const RobotBody kBody = robot_body(kRobot.footprint, kRobot.limits, kRobot.laser, 1.0);
const auto kSide = static_cast<float>(kRobot.footprint.half_width_m);

/// A laser that looks all round at (0, 0), a beam a degree, beside a straight wall on its left: along x, from `from_x`
/// on.
LaserScan beside_wall(float gap_m, float from_x = -9.0F) {
  LaserScan scan = tests::scan_of(
      {.robot_from_laser = {}, .fov_rad = 2.0 * kPi, .beams = 361, .range_min_m = 0.02, .range_max_m = 20.0}, INFINITY);
  for (std::size_t beam = 0; beam < scan.beam_count; ++beam) {
    const double rad = scan.angle_rad(beam);
    const double range = static_cast<double>(kSide + gap_m) / std::sin(rad);
    const bool hits = range > 0.0 && range < 15.0 && range * std::cos(rad) >= static_cast<double>(from_x);
    if (hits) scan.range_m[beam] = static_cast<float>(range);
  }
  return scan;
}

/// The most that is taken away while it holds this twist for half a second.
float braked(const LaserScan& scan, float v, float w, std::span<const MoverDisc> movers = {}) {
  NearReturns returns;
  RobotState robot{.v = v, .w = w};
  returns.update(SeenFrom{&scan, {}}, robot, kBody, movers, {});
  float most = 0.0F;
  for (int step = 0; step < 5; ++step) {
    robot = moved(robot, {v, w}, kBody.bounds, 0.1F);
    most = std::max(most, returns.braked_share(robot, kBody));
  }
  return most;
}

}  // namespace

TEST_CASE("along a wall it is braked to the speed whose margin the gap leaves") {
  CHECK(braked(beside_wall(0.07F), 0.6F, 0.0F) == Approx(1.0F - 0.2F / 0.6F).margin(0.02));  // 2 of 4 cm: 0.2 m/s
  CHECK(braked(beside_wall(0.07F), 0.15F, 0.0F) == 0.0F);
  CHECK(braked(beside_wall(0.045F), 0.3F, 0.0F) == Approx(1.0F - 0.1F / 0.3F).margin(0.02));  // it may creep
  CHECK(braked(beside_wall(0.045F), 0.05F, 0.3F) == 1.0F);                                    // and not swing
  CHECK(braked(beside_wall(0.1F), 0.6F, 0.0F) == 0.0F);
}

TEST_CASE("what either of two scanners hits brakes it") {
  LaserScan open = beside_wall(0.07F);
  open.range_m.fill(INFINITY);
  const LaserScan wall = beside_wall(0.07F);
  const SeenFrom nothing{&open, {}}, hit{&wall, {}};
  const RobotState robot{.v = 0.6F};
  const auto taken = [&](const SeenFrom& newest, const SeenFrom& other) {
    NearReturns returns;
    returns.update({newest, {&other, 1}}, robot, kBody, {}, {});
    return returns.braked_share(moved(robot, {0.6F, 0.0F}, kBody.bounds, 0.3F), kBody);
  };
  CHECK(taken(nothing, nothing) == 0.0F);
  CHECK(taken(hit, nothing) > 0.5F);
  CHECK(taken(nothing, hit) == taken(hit, nothing));
}

TEST_CASE("it may leave what it stands beside: a wall's end behind its front, the wall by turning off") {
  CHECK(braked(beside_wall(0.05F, 0.15F), 0.3F, 0.0F) == Approx(1.0F - 0.1F / 0.3F).margin(0.02));  // to a creep
  CHECK(braked(beside_wall(0.05F, 0.15F), -0.3F, 0.0F) == 0.0F);
}

TEST_CASE("what may be a mover's body does not count, nor does what is out of reach") {
  const MoverDisc mover{{0.3, 0.3}, 0.3};
  CHECK(braked(beside_wall(0.05F, 0.15F), 0.6F, 0.0F) > 0.8F);
  CHECK(braked(beside_wall(0.05F, 0.15F), 0.6F, 0.0F, {&mover, 1}) < 0.6F);
  CHECK(braked(LaserScan{}, 0.6F, 0.0F) == 0.0F);
}

TEST_CASE("what the supervisor's stop zone would stop at once is foreseen, with a range's noise to spare") {
  const StopZone zone({.footprint = kRobot.footprint, .robot_from_laser = {}});
  int stopped = 0;
  for (float gap = 0.02F; gap < 0.1F; gap += 0.005F) {
    for (const float v : {-0.3F, 0.05F, 0.1F, 0.2F, 0.3F, 0.45F, 0.6F}) {
      for (const float w : {-1.0F, -0.3F, 0.0F, 0.3F, 1.0F}) {
        const LaserScan scan = beside_wall(gap);
        const Twist2 twist{static_cast<double>(v), static_cast<double>(w)};
        const bool creeps = zone.rim_speed_mps(twist) < 1.01 * StopZoneRules<double>::kCreep_mps &&
                            zone.may_creep(scan, twist, {}, 0.2);
        if (creeps || zone.gap_m(scan, twist) > 0.0) continue;
        ++stopped;
        INFO("gap " << gap << ", v " << v << ", w " << w);
        CHECK(braked(scan, v, w) > 0.0F);
      }
    }
  }
  CHECK(stopped > 100);
}
