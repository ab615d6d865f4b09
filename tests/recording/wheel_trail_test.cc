#include <cmath>

#include "apps/formats/logs/recorded_log.h"
#include "tests/support/catch.h"

namespace jaywalk::sim {
namespace {

/// Exact arcs in another form than the one under test: circle's centre to circle's rim.
Pose2 integrate(Pose2 pose, const WheelState& from, const WheelState& to, const DriveModel& drive) {
  const double left = (to.left_rad - from.left_rad) * drive.wheel_radius_m;
  const double right = (to.right_rad - from.right_rad) * drive.wheel_radius_m;
  const double turn = (right - left) / drive.track_width_m;
  const double way = (right + left) / 2.0;
  if (std::fabs(turn) < 1e-9) {
    return {pose.x + way * cos(pose.heading), pose.y + way * sin(pose.heading), pose.heading};
  }
  const double radius = way / turn;
  const double heading = pose.heading + turn;
  return {pose.x + radius * (sin(heading) - sin(pose.heading)), pose.y - radius * (cos(heading) - cos(pose.heading)),
          wrap_angle(heading)};
}

OdometryPose at(double t, Pose2 pose) { return {time_from_seconds(t), pose, std::nullopt}; }

TEST_CASE("the way from pose to pose turns the wheels by hand's reckoning") {
  struct Row {
    const char* name;
    Pose2 from, to;
    Approx left_rad, right_rad;  // of wheels of 0.1 m, 0.5 m apart
  };
  const Row rows[] = {
      {"a metre ahead", {2, 3, kPi / 2}, {2, 4, kPi / 2}, Approx(10.0), Approx(10.0)},
      // A quarter circle about a point one metre left: 0.75 * pi/2 = 1.1781 m and 1.25 * pi/2 = 1.9635 m.
      {"a quarter circle to the left",
       {0, 0, 0},
       {1, 1, kPi / 2},
       Approx(11.781).epsilon(1e-4),
       Approx(19.635).epsilon(1e-4)},
      // 90 degrees with 0.5 m between the wheels: 0.25 * pi/2 = 0.3927 m each.
      {"turning on the spot",
       {0, 0, 3},
       {0, 0, 3 + kPi / 2 - 2 * kPi},
       Approx(-3.927).epsilon(1e-4),
       Approx(3.927).epsilon(1e-4)},
      {"backing", {0, 0, 0}, {-0.5, 0, 0}, Approx(-5.0), Approx(-5.0)}};
  for (const Row& row : rows) {
    CAPTURE(row.name);
    const auto trail = wheel_trail({at(0, row.from), at(2, row.to)}, nominal_drive());
    REQUIRE(trail.size() == 2);
    CHECK(trail[0].sequence == 1);
    CHECK(trail[0].left_rad == 0.0);
    CHECK(trail[1].left_rad == row.left_rad);
    CHECK(trail[1].right_rad == row.right_rad);
    CHECK(trail[1].left_radps == Approx(trail[1].left_rad / 2.0));
  }
}

TEST_CASE("integrating the wheels back gives the poses that arcs can reach") {
  // A robot of 1 m/s with a turn rate that swings: 2,000 arcs of 20 ms, made by an integrator of
  // this test's own, must come back to within rounding.
  const DriveModel drive = nominal_drive();
  std::vector<OdometryPose> poses{at(0, {1, -2, 0.5})};
  WheelState before;
  for (int i = 1; i <= 2000; ++i) {
    WheelState after = before;
    const double turn = 0.02 * sin(0.01 * i);
    after.left_rad += (0.02 - turn * drive.track_width_m / 2.0) / drive.wheel_radius_m;
    after.right_rad += (0.02 + turn * drive.track_width_m / 2.0) / drive.wheel_radius_m;
    poses.push_back(at(0.02 * i, integrate(poses.back().pose, before, after, drive)));
    before = after;
  }
  const auto trail = wheel_trail(poses, drive);
  CHECK(trail.back().left_rad == Approx(before.left_rad).epsilon(1e-9));
  CHECK(trail.back().right_rad == Approx(before.right_rad).epsilon(1e-9));
}

TEST_CASE("side slip leaves the heading exact and is made up for after a turn") {
  // Slipping 0.1 m to the left cannot be driven. After a quarter turn to the left, that way is
  // ahead, and driving on to (0, 1) ends where the recording does.
  const DriveModel drive = nominal_drive();
  const std::vector<OdometryPose> poses{at(0, {0, 0, 0}), at(0.1, {0, 0.1, 0}), at(0.2, {0, 0.1, kPi / 2}),
                                        at(0.3, {0, 1, kPi / 2})};
  const auto trail = wheel_trail(poses, drive);
  Pose2 pose = poses[0].pose;
  for (std::size_t i = 1; i < trail.size(); ++i) {
    pose = integrate(pose, trail[i - 1], trail[i], drive);
    CHECK(pose.heading == Approx(poses[i].pose.heading).margin(1e-12));
  }
  CHECK(pose.y == Approx(1.0));
}

TEST_CASE("between readings that are seldom the wheels turn evenly, and over a long gap nobody knows") {
  const auto trail =
      wheel_trail({at(0, {}), at(1, {1, 0, 0}), at(1.05, {1.05, 0, 0}), at(4, {2, 0, 0})}, nominal_drive());
  const auto filled = filled_in(trail);
  REQUIRE(filled.size() == 13);  // nine between the first two
  CHECK(filled[3].stamp == time_from_seconds(0.3));
  CHECK(filled[3].left_rad == Approx(3.0));
  CHECK(filled[3].right_rad == Approx(3.0));
  CHECK(filled[3].left_radps == Approx(10.0));
  for (std::size_t k = 0; k < filled.size(); ++k) CHECK(filled[k].sequence == k + 1);
  for (std::size_t k = 1; k < 4; ++k) CHECK(filled[9 + k].left_rad == trail[k].left_rad);
  CHECK(filled_in({}).empty());
}

TEST_CASE("a robot that was seen seldom turned, drove and turned back") {
  // From (0, 0) heading east to (-1, 1) heading east in 3 s: an eighth of a turn to the right, 1.414 m backwards, and
  // back.
  const DriveModel drive = nominal_drive();
  const auto trail = wheel_trail({at(0, {0, 0, 0}), at(3, {-1, 1, 0})}, drive);
  REQUIRE(trail.size() == 4);
  CHECK(to_seconds(trail[1].stamp - trail[0].stamp) == Approx(1.0));
  CHECK(trail[2].sequence == 3);
  CHECK(trail[1].left_rad == Approx(0.25 * kPi / 4 / 0.1));  // 0.5 m between wheels of 0.1 m
  CHECK(trail[2].left_rad - trail[1].left_rad == Approx(-14.142).epsilon(1e-4));
  Pose2 pose;
  for (std::size_t i = 1; i < trail.size(); ++i) pose = integrate(pose, trail[i - 1], trail[i], drive);
  CHECK(pose.x == Approx(-1.0));
  CHECK(pose.y == Approx(1.0));
  CHECK(pose.heading == Approx(0.0).margin(1e-9));
}

TEST_CASE("a few centimetres aside of a robot that hardly drives are slip, not a turn there and back") {
  // 2 cm to the left while it goes 1 cm ahead: the way there lies 63 degrees to the left.
  const auto trail = wheel_trail({at(0, {0, 0, 0}), at(0.25, {0.01, 0.02, 0})}, nominal_drive());
  REQUIRE(trail.size() == 2);
  CHECK(trail[1].left_rad == Approx(0.1));
  CHECK(trail[1].right_rad == Approx(0.1));
  // 2 cm aside on 20 cm ahead are 6 degrees: it drove there.
  CHECK(wheel_trail({at(0, {0, 0, 0}), at(0.25, {0.2, 0.02, 0})}, nominal_drive()).size() == 4);
}

TEST_CASE("recorded speeds are passed on, wheel by wheel") {
  // 1 m/s and 0.4 rad/s: (1 -+ 0.4 * 0.25) / 0.1 = 9 and 11 rad/s.
  const auto trail = wheel_trail({{time_from_seconds(0), {}, Twist2{1.0, 0.4}}}, nominal_drive());
  CHECK(trail[0].left_radps == Approx(9.0));
  CHECK(trail[0].right_radps == Approx(11.0));
}

}  // namespace
}  // namespace jaywalk::sim
