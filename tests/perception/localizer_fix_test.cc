#include <cmath>
#include <limits>
#include <utility>

#include "planner/localization/localizer.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

constexpr DriveModel kDrive{.wheel_radius_m = 0.1, .track_width_m = 0.33, .max_wheel_speed_radps = 14.0};

/// A localizer without scans at the origin, its wheels, and a fix of the same time.
struct Fixed {
  Fixed() {
    fix.stamp = wheels.stamp;
    fix.has_pose = true;
  }
  const PoseEstimate& update(const OutsideFix& by) { return localizer.update(wheels, {}, by, still, {}); }

  Localizer localizer{{.map_from_robot_at_start = {}, .drive = kDrive, .robot_from_laser = {}, .match_scans = false}};
  const EvidenceMap still{64, 0.1, {}};
  WheelState wheels{.stamp = time_from_seconds(0.0), .sequence = 1};
  OutsideFix fix;
};

}  // namespace

TEST_CASE("an outside fix is blended by variance") {
  Fixed robot;
  const double std_before = robot.update({}).position_std_m;  // 0.005
  OutsideFix& fix = robot.fix;
  fix.sequence = 1;
  fix.map_from_robot = {0.01, -0.02, 0.0};
  fix.position_std_m = 2.0 * std_before;  // a quarter of the weight: a fifth of the way
  fix.heading_std_rad = 1.0;
  const PoseEstimate& blended = robot.update(fix);
  CHECK(blended.map_from_robot.x == Approx(0.002));
  CHECK(blended.map_from_robot.y == Approx(-0.004));
  CHECK(blended.position_std_m == Approx(std_before * std::sqrt(0.8)));
}

TEST_CASE("a fix is taken once, and one that is no number or of another time not at all") {
  Fixed robot;
  const WheelState driven = std::exchange(robot.wheels, {});
  OutsideFix& fix = robot.fix;
  fix.sequence = 1;
  fix.map_from_robot = {0.01, 0.0, 0.0};
  fix.position_std_m = 0.005;
  const double once = robot.update(fix).map_from_robot.x;
  CHECK(once > 0.0);
  CHECK(robot.update(fix).map_from_robot.x == once);
  robot.wheels = driven;
  (void)robot.update(fix);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  OutsideFix bad = fix, doubtful = fix, turned = fix, old = fix, early = fix;
  bad.map_from_robot.x = nan;
  doubtful.position_std_m = nan;
  turned.heading_std_rad = -1.0;
  old.stamp = time_from_seconds(-5.0), early.stamp = time_from_seconds(5.0);
  for (OutsideFix useless : {bad, doubtful, turned, old, early}) {
    useless.sequence = ++fix.sequence;
    CHECK(robot.update(useless).map_from_robot.x == once);
  }
}

TEST_CASE("one fix that is far off is a mistake, three that agree as the robot drives on are where it is") {
  Fixed robot;
  (void)robot.update({});
  OutsideFix& fix = robot.fix;
  WheelState& wheels = robot.wheels;
  fix.position_std_m = fix.heading_std_rad = 0.05;
  const auto fixed = [&](double x, double y) -> const PoseEstimate& {  // 0.2 s and 0.1 m on
    wheels.stamp += std::chrono::milliseconds(200);
    ++wheels.sequence, ++fix.sequence;
    wheels.left_rad += 0.1 / kDrive.wheel_radius_m, wheels.right_rad += 0.1 / kDrive.wheel_radius_m;
    fix.stamp = wheels.stamp;
    fix.map_from_robot = {x, y, 0.0};
    return robot.update(fix);
  };
  CHECK(fixed(9.0, 9.0).map_from_robot.x == Approx(0.1));  // each says another place
  CHECK(fixed(3.0, -2.0).map_from_robot.x == Approx(0.2));
  CHECK(fixed(5.3, 1.0).map_from_robot.x == Approx(0.3));
  CHECK(fixed(5.4, 1.0).map_from_robot.x == Approx(0.4));
  const PoseEstimate& found = fixed(5.5, 1.0);
  CHECK(found.map_from_robot.x == Approx(5.5));
  CHECK(found.map_from_robot.y == Approx(1.0));
  CHECK(found.position_std_m == Approx(0.05));
}

TEST_CASE("of a robot that was carried fixes near where it believed to be tell the pose, whatever it was sure of") {
  Fixed robot;
  (void)robot.update({});
  robot.localizer.carried();
  OutsideFix& fix = robot.fix;
  fix.map_from_robot = {0.0, 0.0, 0.2};  // two standard deviations
  fix.position_std_m = fix.heading_std_rad = 0.1;
  PoseEstimate last;
  for (fix.sequence = 1; fix.sequence <= 3; ++fix.sequence) {
    last = robot.update(fix);
    CHECK(last.doubtful == (fix.sequence < 3));
  }
  CHECK(last.map_from_robot.heading == Approx(0.2));
  CHECK(last.heading_std_rad == Approx(0.1));
}
