// What roll-outs count on and what the supervisor permits where nothing watches: one rule in two rooms.
#include "firmware/safety/blind_gaps.h"
#include "planner/motion/robot_body.h"
#include "tests/safety/scans.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// As the supervisor has it: by how much the fastest part that moves outward unwatched exceeds 0.3 m/s.
double taken_away(const RobotModel& robot, const Twist2& twist) {
  BlindGaps gaps(robot.laser);
  gaps.update(tests::scan_of(robot.laser, 3.0F));
  const Watch watch(robot.footprint, 0.08);
  return std::max(watch.unwatched_mps(gaps, twist, SweptPath(twist, 0.0, 0.0)) - 0.3, 0.0);
}

}  // namespace

TEST_CASE("a roll-out counts on no more speed to where nothing looks than the supervisor permits") {
  for (const RobotModel& robot : {p3dx(), wheelchair()}) {
    const motion::BlindRim rim(robot.footprint, robot.laser);
    int held = 0;
    for (double v = -0.6; v <= 0.61; v += 0.05) {
      for (double w = -1.2; w <= 1.21; w += 0.1) {
        const double taken = taken_away(robot, {v, w});
        const double counted = static_cast<double>(rim.too_fast(static_cast<float>(v), static_cast<float>(w)));
        INFO(robot.name << " v " << v << " w " << w << " taken " << taken << " counted " << counted);
        CHECK(counted >= taken - 0.02);
        CHECK(counted <= taken + 0.04);
        held += taken > 0.0 ? 1 : 0;
      }
    }
    CHECK(held > 10);
  }
}

TEST_CASE("a laser that looks all round leaves no blind rim") {
  LaserModel laser = p3dx().laser;
  laser.fov_rad = 2.0 * kPi;
  const motion::BlindRim rim(p3dx().footprint, laser);
  CHECK(rim.too_fast(-0.6F, 1.0F) == 0.0F);
}

TEST_CASE("what one of two lasers looks at is watched, and what neither does is not") {
  RobotModel robot = p3dx();
  LaserModel rear = robot.laser;
  robot.laser.robot_from_laser = {0.2, 0.0, 0.0};  // its 270 degrees end 6 cm behind the middle of the sides
  rear.robot_from_laser = {-0.2, 0.0, kPi};
  CHECK(motion::BlindRim(robot.footprint, robot.laser).is_behind());
  REQUIRE(robot.other_lasers.push_back(rear));
  const motion::BlindRim both(robot.footprint, robot.lasers());
  CHECK_FALSE(both.is_behind());
  CHECK(both.points() == 0);
  robot.laser.fov_rad = robot.other_lasers[0].fov_rad = 0.5 * kPi;  // neither looks aside
  const motion::BlindRim aside(robot.footprint, robot.lasers());
  CHECK(aside.too_fast(0.0F, 1.0F) > 0.0F);
}

TEST_CASE("backing off as fast as is permitted, it turns only as the speed falls") {
  const motion::BlindRim blind(p3dx().footprint, p3dx().laser);
  REQUIRE(blind.too_fast(-0.28F, 0.0F) == 0.0F);
  REQUIRE(blind.too_fast(-0.28F, 0.5F) > 0.0F);
  float before = 0.0F;
  for (const float v : {-0.28F, -0.2F, -0.1F}) {
    const float w = blind.turn_at(v, 1.0F);
    CHECK(blind.too_fast(v, w) == 0.0F);
    CHECK(blind.too_fast(v, w + 0.01F) > 0.0F);  // no less than is needed
    CHECK(w > before);
    CHECK(blind.turn_at(v, -1.0F) == Approx(-w).margin(0.01));
    before = w;
  }
}

TEST_CASE("a turn that is permitted stays, and so does one at a speed that is too fast by itself") {
  const motion::BlindRim blind(p3dx().footprint, p3dx().laser);
  CHECK(blind.turn_at(0.6F, 0.5F) == 0.5F);
  CHECK(blind.turn_at(-0.1F, 0.3F) == 0.3F);
  CHECK(blind.turn_at(-0.5F, 0.3F) == 0.3F);
}
