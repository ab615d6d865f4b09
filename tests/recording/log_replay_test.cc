#include "apps/formats/logs/log_replay.h"

#include <cmath>

#include "tests/recording/recordings.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"

namespace jaywalk::sim {
namespace {

RecordedLog small_log(const Scratch& scratch) {
  return load_scan_odom(scratch.write("scan.txt",
                                      "10.0 0 0.1 0.1 9 2 1 2\n"
                                      "10.1 0 0.1 0.1 9 3 3 4 5\n"
                                      "10.3 0 0.1 0.1 9 2 6 7\n"),
                        scratch.write("odom.txt",
                                      "9.9 1 1 0 0 0\n"
                                      "10.0 2 1 0 1 0\n"
                                      "10.2 3 1 0 1 0\n"
                                      "10.9 8 1 0 1 0\n"));
}

TEST_CASE(
    "a replay shows the newest reading that is not younger than the clock, from the recording's begin to its end") {
  const Scratch scratch;
  LogReplay replay(small_log(scratch));
  CHECK(replay.start_pose() == Pose2{2, 1, 0});
  CHECK(replay.last_pose() == Pose2{3, 1, 0});
  CHECK(replay.end_time() == time_from_seconds(10.3));
  const Hal hal = replay.hal();
  CHECK(hal.clock.now() == time_from_seconds(10.0));
  CHECK(hal.laser.latest().sequence == 1);
  CHECK(hal.laser.latest().range_m[1] == 2.0F);
  CHECK(hal.drive.latest().sequence == 2);
  CHECK(hal.pose_source.latest().sequence == 0);

  hal.clock.sleep_until(time_from_seconds(10.15));
  CHECK(hal.laser.latest().sequence == 2);
  CHECK(hal.laser.latest().beam_count == 2);  // as the others have
  CHECK(hal.laser.latest().range_m[1] == 4.0F);
  CHECK(hal.laser.latest().period == Duration{200'000'000});
  CHECK(hal.drive.latest().left_rad == Approx(15.0));  // half way from 2 m to 3 m, from 1 m, on wheels of 0.1 m
  CHECK_FALSE(replay.ended());

  hal.clock.sleep_until(time_from_seconds(10.0));  // has passed: time does not go back
  CHECK(hal.clock.now() == time_from_seconds(10.15));
  hal.clock.sleep_until(time_from_seconds(10.3));
  CHECK(hal.laser.latest().sequence == 3);
  CHECK(replay.ended());
}

TEST_CASE("without odometry there are no wheels and no last pose") {
  const Scratch scratch;
  LogReplay replay(load_scan_odom(scratch.write("scan.txt", "1 0 0.1 0.1 9 2 1 2\n")));
  CHECK(replay.hal().drive.latest().sequence == 0);
  CHECK(replay.start_pose() == Pose2{});
  CHECK_FALSE(replay.last_pose().has_value());
}

TEST_CASE("the panel wants nothing until a goal is set") {
  const Scratch scratch;
  LogReplay replay(small_log(scratch));
  CHECK_FALSE(replay.hal().panel.latest().has_goal);
  replay.set_goal({4, 5}, 0.5);
  CHECK(replay.hal().panel.latest().has_goal);
  CHECK(replay.hal().panel.latest().goal_in_map == Vec2{4, 5});
  CHECK(replay.hal().panel.latest().goal_tolerance_m == 0.5);
}

TEST_CASE("the wheelchair's wheels lead back to where its odometry says it went") {
  const auto scan = recording("wheelchair/scan.txt.gz");
  const auto odom = recording("wheelchair/odom.txt.gz");
  if (!scan || !odom) return;
  LogReplay replay(load_scan_odom(*scan, *odom));
  CHECK(replay.log().scans.size() == 271);
  const Hal hal = replay.hal();
  Pose2 pose = replay.start_pose();
  WheelState before = hal.drive.latest();
  while (!replay.ended()) {
    hal.clock.sleep_until(hal.clock.now() + std::chrono::milliseconds(20));
    const WheelState now = hal.drive.latest();
    const double left = (now.left_rad - before.left_rad) * replay.drive().wheel_radius_m;
    const double right = (now.right_rad - before.right_rad) * replay.drive().wheel_radius_m;
    const double turn = (right - left) / replay.drive().track_width_m;
    const Vec2 along = direction(pose.heading + turn / 2) * ((left + right) / 2);
    pose = {pose.x + along.x, pose.y + along.y, wrap_angle(pose.heading + turn)};
    before = now;
  }
  // 36 s and some 30 m driven: two readings a tick, and chords for arcs, cost less than 5 cm.
  CHECK(distance(pose.position(), replay.last_pose()->position()) < 0.05);
  CHECK(std::fabs(wrap_angle(pose.heading - replay.last_pose()->heading)) < 0.02);
}

}  // namespace
}  // namespace jaywalk::sim
