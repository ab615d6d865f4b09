#include "apps/setup/mount_search.h"

#include <cmath>
#include <functional>

#include "apps/setup/clock_search.h"
#include "tests/perception/room.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

constexpr double kMps = 0.6, kRadps = 0.6, kScan_s = 1.0 / 15.0;
constexpr Fan kFan{.beams = 361, .first_rad = -0.75 * kPi, .step_rad = 1.5 * kPi / 360};

Room hall() {
  Room room = rectangle(16.0, 12.0);
  room.walls.push_back({{-2.0, -6.0}, {-2.0, -3.0}});
  room.walls.push_back({{3.0, 6.0}, {3.0, 4.5}});
  room.discs = {{{6.0, -3.0}, 0.4}, {{-6.0, 3.0}, 0.3}};
  return room;
}

/// 6 m ahead, a quarter turn to the left, 4 m on.
Pose2 pose_after(double s) {
  const double turns_s = 6.0 / kMps, turned_s = turns_s + kPi / 2.0 / kRadps;
  if (s < turns_s) return {-4.0 + kMps * s, -1.0, 0.0};
  if (s < turned_s) return {2.0, -1.0, kRadps * (s - turns_s)};
  return {2.0, -1.0 + kMps * (s - turned_s), kPi / 2.0};
}

/// What a laser turned by `yaw` records of `lasts_s` of a way.
sim::RecordedLog recorded_on(const std::function<Pose2(double)>& pose_at, double lasts_s, double yaw) {
  sim::RecordedLog log;
  for (std::uint32_t k = 0; k * kScan_s < lasts_s; ++k) {
    const Pose2 robot = pose_at(k * kScan_s);
    const LaserScan scan = scan_of(hall(), robot * Pose2{0.0, 0.0, yaw}, k + 1, 0.01, kFan);
    log.scans.push_back({scan.stamp, k + 1, log.range_m.size(), scan.beam_count, scan.first_angle_rad,
                         scan.angle_step_rad, scan.range_min_m, scan.range_max_m});
    log.range_m.insert(log.range_m.end(), scan.range_m.begin(), scan.range_m.begin() + scan.beam_count);
    log.odometry.push_back({scan.stamp, robot, std::nullopt});
  }
  return log;
}

sim::RecordedLog recorded_with(double yaw, double lasts_s = 19.0) { return recorded_on(pose_after, lasts_s, yaw); }

/// To and fro by 1.6 rad every 9 s, on a circle's arc of 0.5 m about (0, 1): 9 rad in 25 s.
Pose2 swinging(double s) {
  const double rad = 0.8 * std::sin(2.0 * kPi / 9.0 * s);
  const Vec2 p = Vec2{0.0, 1.0} + direction(rad - kPi / 2.0) * 0.5;
  return {p.x, p.y, rad};
}

/// The same, with odometry stamped `ahead_s` ahead of the scans.
sim::RecordedLog swung(double ahead_s, double lasts_s = 25.0) {
  sim::RecordedLog log = recorded_on(swinging, lasts_s, 0.0);
  for (sim::OdometryPose& next : log.odometry) next.stamp += duration_from_seconds(ahead_s);
  return log;
}

/// 100 steps of 0.1 m along `way`, the robot believing to look along `heading`.
MountCheck after_driving(double way, double heading) {
  MountCheck check;
  for (int k = 0; k <= 100; ++k) {
    const Vec2 p = direction(way) * (0.1 * k);
    check.add({p.x, p.y, heading});
  }
  return check;
}

}  // namespace

TEST_CASE("the yaw of a laser of which nobody says how it is mounted is found") {
  for (const double yaw : {0.7, -0.3}) {
    INFO("yaw " << yaw);
    const auto found = found_mount_yaw(recorded_with(yaw));
    REQUIRE(found.has_value());
    CHECK(*found == Approx(yaw).margin(0.03));
  }
}

TEST_CASE("a laser that looks where the wheels drive is left as it is, and so is one of too short a way") {
  CHECK_FALSE(found_mount_yaw(recorded_with(0.0)).has_value());
  CHECK_FALSE(found_mount_yaw(recorded_with(0.7, 6.0)).has_value());  // 3.6 m
}

TEST_CASE("without wheels no yaw is found") {
  sim::RecordedLog log = recorded_with(0.7);
  log.odometry.clear();
  CHECK_FALSE(found_mount_yaw(log).has_value());
}

TEST_CASE("odometry by another clock than the scans is found by its turns") {
  for (const double ahead_s : {0.22, -0.3}) {
    const auto found = found_clock_offset(swung(ahead_s));
    REQUIRE(found.has_value());
    CHECK(*found == Approx(ahead_s).margin(0.03));
  }
}

TEST_CASE("one clock is left as it is, and so is a recording that turns too little or has no wheels") {
  CHECK_FALSE(found_clock_offset(swung(0.0)).has_value());
  CHECK_FALSE(found_clock_offset(swung(0.05)).has_value());
  CHECK_FALSE(found_clock_offset(swung(0.3, 6.0)).has_value());
  sim::RecordedLog log = swung(0.3);
  log.odometry.clear();
  CHECK_FALSE(found_clock_offset(log).has_value());
}

TEST_CASE("a robot that drives where it looks has its laser mounted right") {
  CHECK_FALSE(after_driving(0.7, 0.7).missing_yaw().has_value());
  CHECK_FALSE(MountCheck{}.missing_yaw().has_value());
}

TEST_CASE("one that seems to slide 0.7 rad to the right has a laser that looks 0.7 rad to the left") {
  // It looks along 2.3 and goes along 1.6, as the wheelchair's recording does without its mount.
  const auto yaw = after_driving(1.6, 2.3).missing_yaw();
  REQUIRE(yaw.has_value());
  CHECK(*yaw == Approx(0.7));
}
