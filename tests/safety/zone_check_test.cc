// The stop zone reaches as far as the robot needs to stop, whatever robot it is (SAFETY 7 and 19).
#include <string>

#include "firmware/safety/stop_zone.h"
#include "tests/safety/driven_robot.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

using namespace jaywalk;

namespace {

constexpr Duration kTick = std::chrono::milliseconds(20);

std::string refusal(const RobotModel& model, Duration tick = kTick) {
  return refusal_of([&] { require_zone_in_reach(model, tick, "robot.toml"); });
}

}  // namespace

TEST_CASE("the built-in robots reach as far as they need, at any rate of the loop") {
  for (const double hz : {20.0, 50.0, 200.0}) {
    for (const RobotModel& model : {p3dx(), at(p3dx(), 1.2), wheelchair()})
      CHECK(refusal(model, duration_from_seconds(1.0 / hz)).empty());
  }
}

TEST_CASE("the longest stop counts the rim's speed, the oldest scan, the slowest loop and drive, and the braking") {
  // p3dx: 0.6 + 1.5 x 0.36845 = 1.1527 m/s. Scans of 15 Hz: 3.7 periods, 0.24667 s; 0.02 + 0.1 + 0.3 s.
  // 1.1527 x 0.66667 + 1.1527^2 / 2 = 1.4328 m.
  CHECK(fastest_rim_mps(p3dx()) == Approx(1.1527).epsilon(1e-4));
  CHECK(longest_stop_m(p3dx(), kTick) == Approx(1.4328).epsilon(1e-3));
}

TEST_CASE("a robot that outruns what its laser sees is refused with what to do about it") {
  RobotModel fast = at(p3dx(), 2.0);
  fast.limits.brake_mps2 = 0.5;
  CHECK(refusal(fast).empty());  // 8.2 m of 25
  fast.laser.range_max_m = 5.0;
  const std::string said = refusal(fast);
  INFO(said);
  CHECK(said.starts_with("robot.toml: stopping takes 8.2 m, "));
  CHECK(holds(said, "its range is 5.0 m; lower limits.max_speed_mps to 1.27, raise limits.brake_mps2"));
}

TEST_CASE("a base that obeys and reports late is refused from the speed on that outruns the laser with it") {
  RobotModel slow = at(p3dx(), 1.2);
  slow.laser.range_max_m = 3.5;
  CHECK(refusal(slow).empty());
  slow.drive.times = {.report_s = 0.25, .late_s = 0.2, .response_s = 0.5};
  const std::string said = refusal(slow);
  const std::string to = "lower limits.max_speed_mps to ";
  REQUIRE(said.find(to) != std::string::npos);
  const double would_do = std::stod(said.substr(said.find(to) + to.size()));
  CHECK(would_do < 1.2);
  CHECK(refusal(at(slow, would_do)).empty());
  CHECK_FALSE(refusal(at(slow, would_do + 0.02)).empty());
}

TEST_CASE("a robot before which a post of 70 mm fits between two beams is refused") {
  RobotModel fast = at(p3dx(), 2.0);
  fast.limits.brake_mps2 = 0.5;
  fast.laser.beams = 271;  // a degree: from 0.07 m / (2 sin 0.5 deg) = 4.0 m on
  CHECK(holds(refusal(fast), "a post of 70 mm fits between two of its beams from 4.0 m"));
  RobotModel two = p3dx();
  two.laser.beams = 2;
  CHECK_FALSE(refusal(two).empty());
}

TEST_CASE("a robot whose stop is longer than the stop zone can be is refused") {
  RobotModel train = at(p3dx(), 10.0);
  train.limits.brake_mps2 = 1.0;
  train.laser.range_max_m = 300.0;
  train.laser.beams = 2048;
  train.laser.fov_rad = 0.5;
  CHECK(holds(refusal(train), "the stop zone ends at 20.5 m"));
}

TEST_CASE("a robot of 2 m/s that brakes with 0.5 m/s2 stops before a wall that it sees from afar, and from 2.9 m") {
  const double brake = GENERATE(0.5, 1.0, 3.0);
  const double wall_m = GENERATE(2.9, 9.0);
  RobotModel fast = at(p3dx(), 2.0);
  fast.limits.brake_mps2 = brake;
  DrivenRobot robot(fast, {{.centre = {wall_m + 0.1, 0.0}, .half = {0.1, 3.0}}});
  robot.drive(1500, 2.0, 0.05);
  CHECK(robot.least_m > 0.03);
  CHECK(robot.least_m < 0.3);
}

TEST_CASE("at every rate of loop and scanner a wall is stopped for") {
  const double loop_hz = GENERATE(20.0, 50.0, 200.0);
  const double scan_hz = GENERATE(5.0, 15.0, 50.0);
  RobotModel model = at(p3dx(), 1.2);
  model.laser.rate_hz = scan_hz;
  const Duration tick = duration_from_seconds(1.0 / loop_hz);
  DrivenRobot robot(model, {{.centre = {4.0, 0.0}, .half = {0.1, 3.0}}}, {.model = model, .tick = tick});
  robot.drive(static_cast<int>(12.0 * loop_hz), 1.2, 1.0 / loop_hz);
  CAPTURE(loop_hz, scan_hz);
  CHECK(robot.least_m > 0.0);
}
