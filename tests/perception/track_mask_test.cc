#include <array>
#include <memory>

#include "planner/localization/scan_matcher.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// Points on the robot's x axis, every 10 cm from 1.0 to 2.0 m.
std::unique_ptr<ScanPoints> points_ahead() {
  auto points = std::make_unique<ScanPoints>();
  for (int k = 10; k <= 20; ++k) (void)points->push_back({{0.1 * k, 0.0}, 0.1 * k, 0});
  return points;
}

/// Seen at 5 s, 1.25 m ahead of a robot that stands at (3, 4) and looks along +y; walks away from it at 1 m/s.
Track walker() {
  Track track;
  track.stamp = time_from_seconds(5.0);
  track.position_in_map = {3.0, 5.25};
  track.velocity_in_map = {0.0, 1.0};
  track.radius_m = 0.12;
  return track;
}
const Pose2 kRobot{3.0, 4.0, kPi / 2};

}  // namespace

TEST_CASE("what lies on a walker where he is by now is left out and the rest keeps its order") {
  const auto points = points_ahead();
  mask_moving_tracks(std::array{walker()}, kRobot, time_from_seconds(5.2), *points);
  REQUIRE(points->size() == 5);  // he is 1.45 m ahead, 0.32 m with a hand on each side: 1.2 to 1.7 are his
  CHECK((*points)[1].in_robot.x == Approx(1.1));
  CHECK((*points)[2].in_robot.x == Approx(1.8));
}

TEST_CASE("a walker seen long ago is not followed for longer than a quarter second, nor back in time") {
  auto points = points_ahead();
  mask_moving_tracks(std::array{walker()}, kRobot, time_from_seconds(9.0), *points);
  REQUIRE(points->size() == 4);  // 1.5 m: 1.2 to 1.8
  CHECK((*points)[2].in_robot.x == Approx(1.9));
  points = points_ahead();
  mask_moving_tracks(std::array{walker()}, kRobot, time_from_seconds(4.0), *points);
  REQUIRE(points->size() == 5);  // 1.25 m: 1.0 to 1.5
  CHECK((*points)[0].in_robot.x == Approx(1.6));
}
