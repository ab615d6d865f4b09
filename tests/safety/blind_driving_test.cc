// Beams that prove nothing: the robot never touches what they hide (SAFETY 9 and 17).
#include <array>
#include <random>

#include "tests/safety/driven_robot.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

constexpr double kDeg = kPi / 180.0;

/// All beams within half of `width_rad` of a direction say `range_m`.
void lose(LaserScan& scan, double middle_rad, double width_rad, float range_m) {
  for (std::size_t k = 0; k < scan.beam_count; ++k) {
    if (std::fabs(scan.angle_rad(k) - middle_rad) <= 0.5 * width_rad) scan.range_m[k] = range_m;
  }
}

/// Whether a post of 70 mm could stand unseen where the body goes, straight on, within `ahead_m` of its front: no beam
/// that crosses such a post measured anything.
bool hides_a_post(const LaserScan& scan, const RobotModel& model, double ahead_m) {
  const Footprint& body = model.footprint;
  for (double x = body.front_m; x <= body.front_m + ahead_m; x += 0.02) {
    for (double y = -body.half_width_m; y <= body.half_width_m; y += 0.02) {
      const Vec2 p = Vec2{x, y} - model.laser.robot_from_laser.position();
      const double way = std::atan2(p.y, p.x), half = std::asin(std::min(1.0, 0.035 / norm(p)));
      bool seen = false, looked_at = false;
      for (std::size_t k = 0; k < scan.beam_count; ++k) {
        if (std::fabs(scan.angle_rad(k) - way) > half) continue;
        looked_at = true;
        seen = seen || scan.is_hit(k) || scan.found_nothing(k);
      }
      if (looked_at && !seen) return true;
    }
  }
  return false;
}

}  // namespace

TEST_CASE(
    "in 200 placements of an obstacle and lost beams the robot never touches it, and goes slowly where it could") {
  std::mt19937_64 random(20261123);
  const auto between = [&random](double least, double most) {
    return least + (most - least) * static_cast<double>(random() >> 11) / 9007199254740992.0;
  };
  int slow = 0, free = 0;
  for (int placement = 0; placement < 200; ++placement) {
    const double speed = std::array{0.3, 0.6, 1.2}[static_cast<std::size_t>(placement) % 3];
    const RobotModel model = at(placement % 2 == 1 ? wheelchair() : p3dx(), speed);
    const double x = between(1.2, 3.0), y = between(-0.4, 0.4);
    Obstacle obstacle{.centre = {x, y}, .radius_m = between(0.035, 0.3)};
    if (placement % 4 >= 2) {
      obstacle = {.centre = {x + 0.3, y},
                  .half = {between(0.035, 0.2), between(0.035, 0.6)},
                  .heading = between(-0.5 * kPi, 0.5 * kPi)};
    }
    DrivenRobot robot(model, {obstacle});
    const double middle = between(-0.3, 0.3), width = model.laser.fov_rad * std::pow(between(0.0, 1.0), 3.0);
    const float says =
        std::array{0.0F, std::nanf(""), -1.0F, 0.01F, -INFINITY}[static_cast<std::size_t>(placement) % 5];
    robot.spoil = [=](LaserScan& scan) { lose(scan, middle, width, says); };
    const double turn = between(-0.1, 0.1);
    INFO("placement " << placement << ": obstacle at " << x << ", " << y << ", gap of " << width / kDeg
                      << " degrees at " << middle / kDeg);
    double least_m = 10.0, fastest_mps = 0.0;
    Twist2 permitted;
    for (int k = 0; k < 600; ++k) {
      const double wanted = std::min(speed, permitted.v_mps + 0.02);  // a follower's ramp
      permitted = robot.tick({wanted, turn * wanted}).permitted;
      if (k % 5 == 0) least_m = std::min(least_m, robot.clearance_m());
      fastest_mps = std::max(fastest_mps, robot.speed_mps());
      if (least_m == 0.0) break;
      if (k % 50 == 0 && permitted.v_mps > 0.3 + 1e-9) {
        const double stop_m =
            permitted.v_mps * (1.5 / model.laser.rate_hz + 0.08) + 0.5 * permitted.v_mps * permitted.v_mps;
        CHECK_FALSE(hides_a_post(robot.scan(), model, stop_m));
      }
    }
    CHECK(least_m > 0.0);
    (fastest_mps > 0.31 ? free : slow) += 1;
  }
  CHECK(slow > 20);
  CHECK(free > 20);
}

TEST_CASE("all beams but one at 0, or 120 degrees ahead: the robot stays where it is") {
  const double speed = GENERATE(0.3, 0.6, 1.2);
  const bool all = GENERATE(true, false);
  DrivenRobot robot(at(p3dx(), speed), {{.centre = {1.0, 0.0}, .radius_m = 0.1}});
  robot.spoil = [all](LaserScan& scan) {
    if (all) std::fill_n(scan.range_m.begin(), 810, 0.0F);
    if (!all) lose(scan, 0.0, 120.0 * kDeg, 0.0F);
  };
  robot.drive(100, speed);
  CHECK(robot.pose().x < 0.02);
}

TEST_CASE("beams that are lost while the robot drives stop it, as hard as it brakes") {
  DrivenRobot robot(at(p3dx(), 1.2), {});
  REQUIRE(robot.drive(100, 1.2).permitted.v_mps == 1.2);
  robot.spoil = [](LaserScan& scan) { lose(scan, 0.0, 120.0 * kDeg, 0.0F); };
  const double from_m = robot.pose().x;
  robot.drive(150, 1.2);
  CHECK(robot.speed_mps() < 0.001);
  // At most a scan's period until it is known, v^2 / 2b = 0.72 m, and the wheels' lag of 0.05 s.
  CHECK(robot.pose().x - from_m < 1.2 * (0.067 + 0.02 + 0.05) + 0.72 + 0.02);
}

TEST_CASE("one lost beam of a fine scanner costs nothing, nor does every third") {
  const std::size_t every = GENERATE(811U, 3U);
  DrivenRobot robot(at(p3dx(), 0.6), {});
  robot.spoil = [every](LaserScan& scan) {
    for (std::size_t k = 405 % every; k < scan.beam_count; k += every) scan.range_m[k] = 0.0F;
  };
  const Verdict verdict = robot.drive(100, 0.6);
  CHECK(verdict.permitted.v_mps == 0.6);
  CHECK(verdict.reasons == Reason::kNone);
}

TEST_CASE("with lost beams beside it the robot drives on, and away from those ahead of it it backs") {
  DrivenRobot beside(at(p3dx(), 0.6), {}), before(at(p3dx(), 0.6), {});
  beside.spoil = [](LaserScan& scan) { lose(scan, 90.0 * kDeg, 30.0 * kDeg, 0.0F); };
  before.spoil = [](LaserScan& scan) { lose(scan, 0.0, 30.0 * kDeg, 0.0F); };
  CHECK(beside.drive(100, 0.6).permitted.v_mps == 0.6);
  CHECK(before.tick({0.1, 0.0}).permitted.v_mps == 0.0);
  CHECK(before.tick({-0.1, 0.0}).permitted.v_mps == -0.1);
}
