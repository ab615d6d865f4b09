// Calibration on a simulated robot that is not what its model says.
#include "apps/setup/calibration.h"
#include "hal/sim/simulation.h"
#include "tests/robot/robot_file_text.h"
#include "tests/robot/wired_bench.h"

using namespace jaywalk;

namespace {

sim::Scenario hall(const sim::TrueRobot& truth) {
  sim::Scenario scenario = tests::empty_hall();
  scenario.truth = truth;
  return scenario;
}

/// Driven by a program that believes `model`.
std::vector<CalibrationLog> guided(
    const sim::Scenario& scenario, std::uint64_t seed, const RobotModel& model,
    const std::function<bool()>& stopped = [] { return false; }) {
  sim::Simulation world(scenario, seed);
  const Hal hal = world.hal();
  std::vector<LaserScanner*> lasers{&hal.laser};
  lasers.insert(lasers.end(), hal.other_lasers.begin(), hal.other_lasers.end());
  return drive_guided({model, hal.drive, lasers, hal.clock, stopped});
}

void check_mount(const Pose2& found, const Pose2& truth) {
  CAPTURE(found.x, found.y, found.heading);
  CHECK(distance(found.position(), truth.position()) < 0.01);
  CHECK(std::fabs(wrap_angle(found.heading - truth.heading)) < 0.5 * kPi / 180.0);
}

void check_found(const RobotGeometry& found, const sim::TrueRobot& truth) {
  CAPTURE(found.left_radius_m, found.right_radius_m, found.track_width_m);
  CHECK(std::fabs(found.left_radius_m / *truth.left_wheel_radius_m - 1.0) < 0.005);
  CHECK(std::fabs(found.right_radius_m / *truth.right_wheel_radius_m - 1.0) < 0.005);
  CHECK(std::fabs(found.track_width_m / *truth.track_width_m - 1.0) < 0.01);
  check_mount(found.robot_from_laser, *truth.robot_from_laser);
}

}  // namespace

TEST_CASE("wheel radii, track width and mount come out, whatever the file says") {
  const sim::TrueRobot larger{0.0985, 0.0968, 0.341, Pose2{0.12, 0.015, 0.05}},
      smaller{0.0930, 0.0934, 0.318, Pose2{-0.03, -0.04, -0.08}};
  for (const auto& [truth, turns] : {std::pair{larger, true}, std::pair{smaller, false}}) {
    sim::Scenario scenario = hall(truth);
    scenario.model.laser.turns = turns;
    const Calibration result = calibrate(guided(scenario, 1, scenario.model).front(), believed_of(scenario.model));
    const RobotGeometry &found = result.found, &within = result.within;
    CAPTURE(turns);
    check_found(found, truth);
    // The intervals hold the truth, and are no wider than the figures above.
    CHECK(std::fabs(found.left_radius_m - *truth.left_wheel_radius_m) < within.left_radius_m);
    CHECK(std::fabs(found.track_width_m - *truth.track_width_m) < within.track_width_m);
    CHECK(within.left_radius_m < 0.005 * found.left_radius_m);
    CHECK(within.track_width_m < 0.01 * found.track_width_m);
    CHECK(within.robot_from_laser.x < 0.01);
    CHECK(result.left_out < 4);
  }
}

TEST_CASE("of two scanners the mount of each is found by its own scans") {
  sim::Scenario scenario = hall({});
  LaserModel rear = scenario.model.laser;
  rear.robot_from_laser = {-0.2, 0.0, kPi};
  rear.rate_hz = 20.0;
  REQUIRE(scenario.model.other_lasers.push_back(rear));
  RobotModel believed = scenario.model;
  believed.laser.robot_from_laser = {0.04, -0.03, 0.06};
  believed.other_lasers[0].robot_from_laser = {-0.15, 0.03, kPi - 0.07};
  const std::vector<CalibrationLog> logs = guided(scenario, 1, believed);
  REQUIRE(logs.size() == 2);
  for (const std::size_t k : {0U, 1U}) {
    CAPTURE(k);
    check_mount(calibrate(logs[k], believed_of(believed, k)).found.robot_from_laser,
                scenario.model.lasers()[k].robot_from_laser);
  }
}

TEST_CASE("a way straight on tells no track width, and its interval says so") {
  const sim::Scenario scenario = hall({});
  sim::Simulation world(scenario, 1);
  const Hal hal = world.hal();
  CalibrationLog log(scenario.model.drive);
  for (int tick = 0; tick < 1000; ++tick) {
    const double speed = tick % 400 < 200 ? 4.0 : -4.0;  // rad/s, to and fro
    hal.clock.sleep_until(hal.clock.now() + std::chrono::milliseconds(20));
    hal.drive.command({hal.clock.now(), speed, speed});
    log.take(hal.drive.latest(), hal.laser.latest());
  }
  const Calibration result = calibrate(log, believed_of(scenario.model));
  CHECK(result.within.track_width_m > 0.05);
  CHECK(result.within.robot_from_laser.x > 0.1);
  CHECK(result.within.left_radius_m < 0.01 * result.found.left_radius_m);
}

TEST_CASE("the guided drive ends at rest where it is told to, where something is near, and where nothing moves") {
  sim::Scenario scenario = hall({});
  const auto complaint = [&scenario](const std::function<bool()>& stopped) {
    sim::Simulation world(scenario, 1);
    const Hal hal = world.hal();
    LaserScanner* const laser = &hal.laser;
    const std::string said = refusal_of([&] {
      return drive_guided({scenario.model, hal.drive, {&laser, 1}, hal.clock, stopped});
    });
    hal.clock.sleep_until(hal.clock.now() + std::chrono::milliseconds(500));
    CHECK(std::fabs(world.truth().twist.v_mps) < 0.01);
    CHECK(world.truth().contacts == 0);
    return said;
  };
  int asked = 0;
  CHECK(complaint([&asked] { return ++asked > 150; }).starts_with("calibration: broken off"));
  scenario.faults = {{.at_s = 3.0, .for_s = 1000.0, .kind = sim::FaultKind::kLeftWheelStuck}};
  CHECK(complaint([] { return false; }).starts_with("calibration: a wheel does not turn as commanded"));
  scenario.faults.clear();
  scenario.start = {2.0, 3.0, kPi};  // 1.3 m to the wall: too near for the straight
  CHECK(complaint([] { return false; }).starts_with("calibration: something stands too near"));
}

TEST_CASE("a handful of scans is no drive") {
  const CalibrationLog log(p3dx().drive);
  CHECK_THROWS_WITH(calibrate(log, believed_of(p3dx()), "the rear scanner's scans"),
                    Catch::Contains("only 0 motions show in the rear scanner's scans and wheels alike"));
}

TEST_CASE("a robot on wires calibrates itself") {
  const sim::TrueRobot truth{0.0985, 0.0968, 0.341, Pose2{0.12, 0.015, 0.05}};
  tests::LiveBench bench(
      [](const Scratch& folder) { return tests::robot_in(folder.folder(), tests::rig_file("robot")); },
      [&](const RobotFile&) { return hall(truth); });
  static_cast<void>(bench.arm());
  LaserScanner* const laser = &bench.robot.laser();
  const auto never = [] { return false; };
  const ControlSetup& setup = bench.file.setup;
  const CalibrationLog log =
      drive_guided({setup.model, bench.robot.drive(), {&laser, 1}, bench.clock, never, setup.tick()}).front();
  CHECK(bench.speed_mps() < 0.001);
  CHECK(bench.far_end().truth().contacts == 0);
  check_found(calibrate(log, believed_of(setup.model)).found, truth);
}

TEST_CASE("wheels that are not alike drive straight by a file that says so") {
  const RobotFile file =
      tests::load(text_in(tests::rig_file("robot")) +
                  "left_wheel_radius_m = 0.0985\nright_wheel_radius_m = 0.0968\ntrack_width_m = 0.341\n");
  const auto& axes = file.drive.cia402.axes;
  // 76600 counts a turn; a metre at the left rim is 1 / 0.0985 of the wheel's own radians, and 1 / 0.0975 of the
  // loop's.
  CHECK(axes[0].per_rad == Approx(76600.0 / (2.0 * kPi) * 0.0975 / 0.0985));
  CHECK(axes[1].per_rad == Approx(-76600.0 / (2.0 * kPi) * 0.0975 / 0.0968));
  CHECK(file.setup.model.drive.track_width_m == 0.341);
  CHECK(file.setup.model.drive.wheel_radius_m == 0.0975);
}
