#include "planner/localization/localizer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "planner/localization/odometry.h"
#include "planner/tracking/tracker.h"
#include "tests/perception/recordings.h"
#include "tests/perception/room.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

constexpr DriveModel kDrive{.wheel_radius_m = 0.1, .track_width_m = 0.33, .max_wheel_speed_radps = 14.0};

double heading_error(const Pose2& a, const Pose2& b) { return std::fabs(wrap_angle(a.heading - b.heading)); }

/// A robot in a room, its tracker and localizer, once a scan.
struct Drive {
  explicit Drive(const Pose2& start)
      : robot(start),
        counted(start),
        localizer({.map_from_robot_at_start = start, .drive = kDrive, .robot_from_laser = {}}) {}

  /// A scan from where it is; then it drives on, by its wheels a little differently.
  void go(const Room& room, const Pose2& on, const Pose2& on_by_wheels) {
    step(room, robot, counted);
    worst_m = std::max(worst_m, off(robot.position()));
    worst_rad = std::max(worst_rad, off_rad(robot));
    robot = robot * on;
    counted = counted * on_by_wheels;
  }
  /// The truth, and what the wheels believe it to be.
  void step(const Room& room, const Pose2& truth, const Pose2& by_wheels) {
    LaserScan seen = scan_of(room, truth, ++scan, noise_m);
    seen.range_max_m = static_cast<float>(reach_m);
    wheels = wheels_of.reading({to_seconds(seen.stamp), by_wheels});
    look(seen);
  }
  void step_without_wheels(const Room& room, const Pose2& truth) { look(scan_of(room, truth, ++scan, noise_m)); }

  void look(const LaserScan& seen) {
    estimate = localizer.update(wheels, seen, {}, tracker.still(), tracker.moving());
    tracker.update(seen, localizer.map_from_robot_at_scan(), localizer.twist());
  }

  /// How far the estimate is off, m.
  [[nodiscard]] double off(Vec2 truth) const { return distance(estimate.map_from_robot.position(), truth); }
  [[nodiscard]] double off_rad(const Pose2& truth) const { return heading_error(estimate.map_from_robot, truth); }

  Pose2 robot, counted;  ///< where it is, and where its wheels have it
  double worst_m = 0.0, worst_rad = 0.0;
  Localizer localizer;
  Tracker tracker{{.robot_from_laser = {}, .map_side_cells = 256, .map_centre = {}}};
  recordings::WheelsFromPoses wheels_of{kDrive};
  WheelState wheels;
  PoseEstimate estimate;
  std::uint32_t scan = 0;
  double reach_m = 20.0;  ///< of the laser
  double noise_m = 0.01;  ///< of its ranges, half width
};

const Room kFurnished = with({{{3.5, -2.5}, 0.3}}, {{{2.0, 5.0}, {2.0, 3.0}}, {{-3.0, -5.0}, {-3.0, -3.5}}});
const Room kCorridor{.walls = {{{-100.0, -1.0}, {100.0, -1.0}}, {{-100.0, 1.0}, {100.0, 1.0}}}};

}  // namespace

TEST_CASE("without scans to match the pose is the wheels' and its doubt grows with the way") {
  Localizer localizer({.map_from_robot_at_start = {1.0, 2.0, kPi / 2}, .drive = kDrive, .robot_from_laser = {}});
  const EvidenceMap still(64, 0.1, {});
  const LaserScan none;
  WheelState wheels{.stamp = time_from_seconds(0.0), .sequence = 1};
  (void)localizer.update(wheels, none, {}, still, {});
  const double std_at_start = localizer.update(wheels, none, {}, still, {}).position_std_m;
  wheels = {.stamp = time_from_seconds(4.0), .sequence = 2, .left_rad = 20.0, .right_rad = 20.0};
  const PoseEstimate& there = localizer.update(wheels, none, {}, still, {});
  CHECK(there.stamp == time_from_seconds(4.0));
  CHECK(there.map_from_robot.x == Approx(1.0));
  CHECK(there.map_from_robot.y == Approx(4.0));  // 2 m on, facing +y
  CHECK(there.position_std_m > std_at_start + 0.03);
  CHECK(there.heading_std_rad > 0.03);
}

TEST_CASE("wheels that slip are put right by the walls") {
  Drive drive({-2.0, 0.0, 0.0});
  // 3 m straight on; the wheels turn a fifth more than the robot drives and claim a slow turn of 0.2 rad.
  for (int k = 0; k <= 150; ++k) {
    drive.step(kFurnished, {-2.0 + 0.02 * k, 0.0, 0.0}, {0.024 * k, 0.0, 0.2 * k / 150.0});
  }
  CHECK(drive.off({1.0, 0.0}) < 0.1);  // the wheels alone: 0.65 m off
  CHECK(drive.off_rad({}) < 0.01);
}

TEST_CASE("a laser that stands a foot before where it is said to be is followed round turns") {
  const Pose2 robot_from_laser{0.3, 0.0, 0.0};  // the localizer is told that there is nothing between
  Drive drive({0.3, 0.0, 0.0});
  Pose2 laser;
  for (int k = 0; k <= 100; ++k) {  // two turns on the spot of 0.126 rad a scan; a laser there moves 4 cm sideways
    const Pose2 robot{0.0, 0.0, wrap_angle(4.0 * kPi * k / 100)};
    laser = robot * robot_from_laser;
    drive.step(kFurnished, laser, robot);
  }
  CHECK(drive.off(laser.position()) < 0.05);
  CHECK(drive.off_rad(laser) < 0.02);
}

TEST_CASE("scans alone carry the pose round a curve") {
  Drive drive({-2.0, -1.0, 0.0});
  Pose2 truth{-2.0, -1.0, 0.0};
  for (int k = 0; k < 120; ++k) {
    drive.step_without_wheels(kFurnished, truth);
    if (k >= 10) truth = truth * Pose2{0.03, 0.0, 0.015};  // 0.45 m/s and 0.225 rad/s
  }
  const Pose2 seen_from = truth * inverse(Pose2{0.03, 0.0, 0.015});
  CHECK(drive.off(seen_from.position()) < 0.05);
  CHECK(drive.off_rad(seen_from) < 0.01);
  CHECK(drive.localizer.twist().v_mps == Approx(0.45).margin(0.1));
  CHECK(drive.localizer.twist().w_radps == Approx(0.225).margin(0.1));
}

TEST_CASE("a wheel that spins in the air turns the robot as fast as it may, and the scans notice") {
  Drive drive({-4.0, -1.0, 0.0});
  for (int k = 0; k < 120; ++k) {  // at 0.6 m/s; from the fourth second to the fifth a wheel spins
    const bool spins = k >= 60 && k < 75;
    drive.go(kFurnished, spins ? Pose2{0.028, 0.0, 0.073} : Pose2{0.04, 0.0, 0.0}, {0.04, 0.0, 0.0});
  }
  CHECK(drive.worst_m < 0.05);
  CHECK(heading_error(drive.localizer.map_from_robot_at_scan(), {0.0, 0.0, 15 * 0.073}) < 0.02);
}

TEST_CASE("scans alone carry the pose over two seconds without a scan, and say how little they know then") {
  Drive drive({-4.0, -1.0, 0.0});
  double x = -4.0;
  for (int k = 0; k < 60; ++k, x += 0.03) drive.step_without_wheels(kFurnished, {x, -1.0, 0.0});  // 0.45 m/s
  drive.scan += 29, x += 29 * 0.03;
  drive.look(scan_of({}, {}, ++drive.scan));  // the first scan after it shows nothing
  x += 0.03;
  CHECK(drive.estimate.position_std_m > 1.0);
  for (int k = 0; k < 30; ++k, x += 0.03) drive.step_without_wheels(kFurnished, {x, -1.0, 0.0});
  CHECK(drive.off({x - 0.03, -1.0}) < 0.05);
  CHECK(drive.tracker.moving().empty());
}

TEST_CASE("wheels that fall silent under way leave the pose to the scans, and take it up again") {
  Drive drive({-4.0, -1.0, 0.0});
  double x = -4.0, farthest_m = 0.0;
  for (int k = 0; k < 225; ++k, x += 0.03) {  // 0.45 m/s
    const bool silent = k >= 60 && k < 150;
    if (silent)
      drive.step_without_wheels(kFurnished, {x, -1.0, 0.0});
    else
      drive.step(kFurnished, {x, -1.0, 0.0}, {x + 4.0, 0.0, 0.0});
    farthest_m = std::max(farthest_m, drive.off({x, -1.0}));
  }
  CHECK(farthest_m < 0.1);
  CHECK(drive.tracker.moving().empty());
}

TEST_CASE("along a bare corridor the wheels are believed and across it the walls") {
  Drive drive({0.0, 0.0, 0.0});
  // The robot drives 3 m straight on; the wheels agree on that and drift 0.3 rad to the left.
  for (int k = 0; k <= 150; ++k) drive.go(kCorridor, {0.02, 0.0, 0.0}, {0.02, 0.0, 0.002});
  CHECK(drive.estimate.map_from_robot.x == Approx(3.0).margin(0.1));
  CHECK(std::fabs(drive.estimate.map_from_robot.y) < 0.03);
  CHECK(drive.off_rad({}) < 0.01);
}

TEST_CASE("noise on a bare corridor's walls does not hold the robot back or push it on") {
  for (const double metres_by_wheels : {0.9875, 1.0, 1.0125}) {
    Drive drive({0.0, 0.0, 0.0});
    drive.noise_m = 0.06;
    for (int k = 0; k < 600; ++k) drive.go(kCorridor, {0.05, 0.0, 0.0}, {0.05 * metres_by_wheels, 0.0, 0.0});
    const Pose2 seen_from = drive.robot * Pose2{-0.05, 0.0, 0.0};
    const double off_m = drive.estimate.map_from_robot.x - seen_from.x * metres_by_wheels;
    CHECK(std::fabs(off_m) < 0.15);
    CHECK(drive.estimate.position_std_m > 0.08);  // 0.05 and 0.06 m where errors of normals count as knowledge
  }
}

TEST_CASE("wheels that were right for thirty metres are not followed when they spin, fast or slowly") {
  const Pose2 step{0.03, 0.0, 0.02};  // a scan: rounds of 9.4 m
  for (const Pose2& spin : {Pose2{0.08, 0.0, 0.05}, Pose2{0.01, 0.0, 0.005}}) {
    Drive drive({1.5, 0.0, kPi / 2});
    for (int k = 0; k < 1000; ++k) drive.go(kFurnished, step, step);
    drive.worst_m = drive.worst_rad = 0.0;
    for (int k = 0; k < 20; ++k) {  // it stands against something; trusted, the wheels would take it 1.6 m and 0.2 m on
      drive.counted = drive.counted * spin;
      drive.go(kFurnished, {}, {});
    }
    CHECK(drive.worst_m < 0.06);
    CHECK(drive.worst_rad < 0.03);
    CHECK(drive.off(drive.robot.position()) < 0.01);
  }
}

TEST_CASE("wheels that were long right are believed after a stretch of which the laser sees nothing") {
  Drive drive({0.0, 0.0, 0.0});
  const auto drive_on = [&](int scans) {
    for (int k = 0; k < scans; ++k) drive.go(kCorridor, {0.05, 0.0, 0.0}, {0.05, 0.0, 0.0});
  };
  drive_on(800);
  const double std_before_m = drive.estimate.position_std_m;
  drive.reach_m = 0.5;
  drive_on(20);
  drive.reach_m = 20.0;
  drive_on(2);
  CHECK(drive.estimate.position_std_m < std_before_m + 0.002);  // of unknown wheels: 0.004 more
}

TEST_CASE("a laser that reaches three metres carries the robot round the end of a wall both faces of which it sees") {
  const Room hall =
      rectangle(16.0, 9.0, {}, {{{-8.0, 0.0}, {0.0, 0.0}}, {{0.0, 0.0}, {0.0, 0.2}}, {{0.0, 0.2}, {-8.0, 0.2}}});
  double sum_m = 0.0;
  for (std::size_t run = 0; run < 16; ++run) {  // one alone is chance
    const double wheels_turn = std::array{0.95, 0.98, 1.02, 1.05}[run % 4],
                 radius_m = 1.1 + 0.04 * static_cast<double>(run / 4);
    Drive drive({-5.0, 0.1 - radius_m, 0.0});
    drive.reach_m = 3.0;
    // 5.2 m on, half round the wall's end, and back along the other face.
    for (int k = 0; k < 500; ++k) {
      const bool turns = k >= 173 && k < 293;
      const Pose2 step{turns ? radius_m * kPi / 120 : 0.03, 0.0, turns ? kPi / 120 : 0.0};
      drive.go(hall, step, {step.x, 0.0, wheels_turn * step.heading});
    }
    CHECK(drive.worst_m < 0.45);
    sum_m += drive.worst_m;
  }
  CHECK(sum_m / 16.0 < 0.25);  // 0.33 m where a face is taken for the other
}

TEST_CASE("people who walk by do not pull the pose along") {
  Drive drive({0.0, 0.0, 0.0});
  for (int k = 0; k < 150; ++k) {
    Room room = kFurnished;
    for (int w = 0; w < 2 && k > 30; ++w) room.discs.push_back({{1.5 + w, -2.0 - 0.5 * w + 0.05 * (k - 30)}, 0.3});
    drive.step_without_wheels(room, {});
  }
  CHECK(norm(drive.estimate.map_from_robot.position()) < 0.05);
  CHECK(drive.off_rad({}) < 0.01);
}

TEST_CASE("the walls between walkers tell how the robot looks, few as they are") {
  Drive drive({});
  Pose2 by_wheels;
  for (int k = 0; k < 120; ++k) {
    Room room = kFurnished;
    for (int w = 0; w < 9 && k >= 30; ++w) {  // round the robot at 0.5 m/s; two beams of three end on them
      room.discs.push_back({direction(2.0 * kPi * w / 9 + 0.026 * k) * 1.3, 0.3});
    }
    drive.step(room, {}, by_wheels);
    if (k > 75) by_wheels.heading += 0.004;
  }
  CHECK(drive.tracker.moving().size() >= 5);
  CHECK(drive.off_rad({}) < 0.01);  // 0.18 by the wheels
}

TEST_CASE("where nobody but walkers is in view those who only come do not pull the pose along") {
  Drive drive({});
  Pose2 before;
  for (int k = 0; k < 90; ++k) {
    Room people;
    const double to_the_left = 0.5 * k / 15.0;  // m, at 0.5 m/s
    people.discs = {{{3.0, to_the_left - 4.0}, 0.3}, {{-1.5, to_the_left - 4.0}, 0.3}};
    if (k >= 45) people.discs.insert(people.discs.end(), {{{2.0, to_the_left - 1.5}, 0.3}, {{4.0, to_the_left}, 0.3}});
    drive.step(people, {}, {});
    if (k == 44) before = drive.estimate.map_from_robot;
  }
  CHECK(drive.off(before.position()) < 1e-9);
  CHECK(drive.off_rad(before) < 1e-9);
}

TEST_CASE("a scan without returns leaves the pose to the wheels") {
  Drive drive({0.0, 0.0, 0.0});
  for (int k = 0; k <= 15; ++k) drive.step({}, {}, {0.02 * k, 0.0, 0.0});
  CHECK(drive.estimate.map_from_robot.x == Approx(0.3));
}

TEST_CASE(
    "where the map does not explain scans the last keyframes keep the robot from following wheels that turn wrong") {
  const auto elsewhere = std::make_unique<Drive>(Pose2{});  // a larger hall: what the robot sees is free there
  for (int k = 0; k < 30; ++k) elsewhere->step_without_wheels(rectangle(20.0, 16.0), {});
  Localizer localizer({.map_from_robot_at_start = {-4.0, 0.0, 0.0}, .drive = kDrive, .robot_from_laser = {}});
  recordings::WheelsFromPoses wheels_of(kDrive);
  Pose2 truth{-4.0, 0.0, 0.0}, by_wheels = truth, at_half;
  for (std::uint32_t k = 1; k <= 80; ++k) {
    truth.x += 0.1;
    by_wheels = after_arc(by_wheels, {0.1, 0.005});  // 0.4 rad in all
    const LaserScan seen = scan_of(kFurnished, truth, k, 0.01);
    const WheelState wheels = wheels_of.reading({to_seconds(seen.stamp), by_wheels});
    (void)localizer.update(wheels, seen, {}, elsewhere->tracker.still(), {});
    if (k == 40) at_half = localizer.map_from_robot_at_scan();
  }
  CHECK(heading_error(by_wheels, truth) > 0.39);
  CHECK(heading_error(localizer.map_from_robot_at_scan(), at_half) < 0.01);  // the wheels say 0.2
}
