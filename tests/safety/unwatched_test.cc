// Where nothing watches, no part of the body goes faster than 0.3 m/s (SAFETY 9).
#include "tests/safety/driven_robot.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

constexpr double kDeg = kPi / 180.0;

/// What is permitted where everything in view is free.
Verdict permitted(const RobotModel& model, const Twist2& wanted) { return DrivenRobot(model, {}).tick(wanted); }

/// A wheelchair that turns as fast as its motors can, its laser where it is told.
RobotModel chair_with(const Pose2& mount, double fov_rad) {
  RobotModel chair = wheelchair();
  chair.limits.max_turn_radps = 1.2;
  chair.laser.robot_from_laser = mount;
  chair.laser.fov_rad = fov_rad;
  return chair;
}

/// Whether a laser sees what is just outside the body at a point of its rim.
bool sees(const LaserModel& laser, Vec2 beyond_rim) {
  const Vec2 d = beyond_rim - laser.robot_from_laser.position();
  const double off = std::remainder(std::atan2(d.y, d.x) - laser.robot_from_laser.heading, 2.0 * kPi);
  return std::fabs(off) <= 0.5 * laser.fov_rad;
}

/// The fastest point of the rim that moves mostly outward to where the laser does not see.
double fastest_unseen_mps(const RobotModel& model, const Twist2& twist) {
  const Footprint& body = model.footprint;
  double fastest = 0.0;
  const auto consider = [&](Vec2 p, Vec2 outward) {
    const Vec2 moves{twist.v_mps - twist.w_radps * p.y, twist.w_radps * p.x};
    const double speed = norm(moves);
    // 0.02: a point whose share is a hair over a half, or whose direction is a hair inside, is left open.
    if (dot(moves, outward) > 0.52 * speed && !sees(model.laser, p + outward * 0.06) &&
        !sees(model.laser, p + outward * 0.1))
      fastest = std::max(fastest, speed);
  };
  for (double y = -body.half_width_m; y <= body.half_width_m; y += 0.01)
    consider({body.front_m, y}, {1.0, 0.0}), consider({-body.rear_m, y}, {-1.0, 0.0});
  for (double x = -body.rear_m; x <= body.front_m; x += 0.01)
    consider({x, body.half_width_m}, {0.0, 1.0}), consider({x, -body.half_width_m}, {0.0, -1.0});
  return fastest;
}

}  // namespace

TEST_CASE("whatever the laser's mount, no part of the body moves faster than 0.3 m/s into what it does not see") {
  const Pose2 mount = GENERATE(Pose2{0.7, 0.0, 0.0}, Pose2{0.85, 0.235, 0.735}, Pose2{0.0, 0.0, 0.0},
                               Pose2{-0.3, 0.0, kPi}, Pose2{0.2, -0.3, -1.5});
  const double fov_deg = GENERATE(180.0, 240.0, 270.0);
  const RobotModel chair = chair_with(mount, fov_deg * kDeg);
  for (double v = -0.6; v <= 0.61; v += 0.3) {
    for (double w = -1.2; w <= 1.21; w += 0.3) {
      CAPTURE(mount.x, mount.y, mount.heading, fov_deg, v, w);
      CHECK(fastest_unseen_mps(chair, permitted(chair, {v, w}).permitted) < 0.3 + 0.01);
    }
  }
}

TEST_CASE("a wheelchair's pivot swings its rear corners at 0.3 m/s, either way round") {
  // 0.35 m back and 0.325 m aside: 0.4776 m from the axle, so 0.6281 rad/s. A laser of 270 degrees at its front does
  // not see them.
  const double way = GENERATE(1.0, -1.0);
  const Verdict verdict = permitted(wheelchair(), {0.0, way});
  CHECK(verdict.permitted.w_radps == Approx(way * 0.6281).epsilon(1e-3));
  CHECK(has(verdict.reasons, Reason::kUnwatched));
  CHECK(permitted(wheelchair(), {0.0, 0.62 * way}).reasons == Reason::kNone);
}

TEST_CASE("a laser that sees all round holds up nothing") {
  const RobotModel chair = chair_with({0.0, 0.0, 0.0}, 2.0 * kPi);
  for (const Twist2 wanted : {Twist2{-0.6, 0.0}, Twist2{0.0, 1.2}, Twist2{0.0, -1.2}, Twist2{0.6, 0.5}})
    CHECK(permitted(chair, wanted).permitted == wanted);
}

TEST_CASE("curves ahead are not held up by a corner that swings out a little behind") {
  const double w = GENERATE(-0.6, -0.3, 0.3, 0.6);
  CHECK(permitted(wheelchair(), {0.6, w}).reasons == Reason::kNone);
  CHECK(permitted(p3dx(), {0.6, 2.0 * w}).reasons == Reason::kNone);
}

TEST_CASE("a nearly round robot with 270 degrees in its middle still turns on the spot at 0.8 rad/s") {
  // Its rear corners, 0.3685 m from the axle, lie outside: 0.3 / 0.3685 = 0.814 rad/s.
  CHECK(permitted(p3dx(), {0.0, 1.5}).permitted.w_radps == Approx(0.8142).epsilon(1e-3));
}

TEST_CASE("a blanked sector is unwatched as far as a post of 70 mm fits into it") {
  struct Part {
    double from_deg, to_deg;
    Twist2 wanted, permitted;
  };
  const double corner_radps = 0.3 / std::hypot(0.75, 0.325);
  const auto [from_deg, to_deg, wanted, expected] =
      GENERATE_COPY(values<Part>({{-15.0, 15.0, {0.5, 0.0}, {0.3, 0.0}},   // ahead: hides a post from 0.14 m on
                                  {-1.0, 1.0, {0.5, 0.0}, {0.5, 0.0}},     // from 2 m on: seen before it is near
                                  {100.0, 110.0, {0.5, 0.0}, {0.5, 0.0}},  // beside it
                                  {60.0, 110.0, {0.0, 0.6}, {0.0, corner_radps}}}));  // where its corner swings
  RobotModel chair = wheelchair();
  (void)chair.laser.blanked.push_back({from_deg * kDeg, to_deg * kDeg});
  DrivenRobot robot(chair, {});
  robot.spoil = [&chair](LaserScan& scan) { blank(chair.laser.blanked, scan); };
  const Verdict verdict = robot.tick(wanted);
  CHECK(verdict.permitted.v_mps == Approx(expected.v_mps));
  CHECK(verdict.permitted.w_radps == Approx(expected.w_radps).epsilon(0.01));
  CHECK(has(verdict.reasons, Reason::kUnwatched) == (wanted != expected));
}
