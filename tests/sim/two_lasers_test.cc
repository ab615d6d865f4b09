// A robot with several scanners: its file, and what each of them gives.
#include <set>

#include "hal/robot_model_file.h"
#include "hal/sim/simulation.h"
#include "tests/sim/made_worlds.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::sim;

namespace {

const std::string kHead = kMap + kRobot + "model = \"p3dx\"\n";
const std::string kFront = "[[robot.laser]]\nmount = [0.2, 0.0, 0.0]\nrate_hz = 10\n";
const std::string kRear = "[[robot.laser]]\nmount = [-0.2, 0.0, 3.1]\nrate_hz = 25\nfov_deg = 180\n";

/// The stamps of each scanner's scans in two seconds.
std::vector<std::set<Time>> stamps(const Scenario& scenario) {
  Simulation sim(scenario, 1);
  Hal hal = sim.hal();
  std::vector<std::set<Time>> seen(1 + hal.other_lasers.size());
  for (int tick = 0; tick < 1000; ++tick) {
    hal.clock.sleep_until(hal.clock.now() + std::chrono::milliseconds(2));
    if (hal.laser.latest().sequence > 0) seen[0].insert(hal.laser.latest().stamp);
    for (std::size_t k = 1; k < seen.size(); ++k) {
      const LaserScan& scan = hal.other_lasers[k - 1]->latest();
      if (scan.sequence > 0) seen[k].insert(scan.stamp);
    }
  }
  return seen;
}

}  // namespace

TEST_CASE("one table is one scanner, however it is written, and each more is like the first but for what it says") {
  CHECK(parsed(kHead + "[robot.laser]\nrate_hz = 10\n").model.lasers().size() == 1);
  CHECK(parsed(kHead + kFront).model.laser.rate_hz == 10.0);
  const RobotModel two = parsed(kHead + kFront + "drop_out = 0.5\nturns = true\n" + kRear).model;
  REQUIRE(two.lasers().size() == 2);
  CHECK(two.lasers()[1].robot_from_laser == Pose2{-0.2, 0.0, 3.1});
  CHECK(two.lasers()[1].rate_hz == 25.0);
  CHECK(two.lasers()[1].beams == p3dx().laser.beams);
  CHECK(two.laser.turns);
}

TEST_CASE("a scanner too many, without a mount, or left out is refused with its line") {
  CHECK(holds(refused(kHead + kFront + "[[robot.laser]]\nrate_hz = 5\n"), "s.toml:10: robot.laser.mount is missing"));
  CHECK(holds(refused(kHead + kFront + kRear + kRear + kRear + kRear), "one scanner's more than 4"));
  CHECK(holds(refused(kHead + kFront + "[[faults]]\nkind = \"scan_stale\"\nscanner = 2\nat_s = 1\nfor_s = 1\n"),
              "is none of this robot's"));
  RobotModel two = parsed(kHead + kFront + kRear).model;
  REQUIRE(two.other_lasers.size() == 1);
  const std::string laser = "[[laser]]\n" + kScanner;
  const std::string file = folder().write("two.toml", kBody + laser + laser);
  CHECK(load_robot_model(file).lasers().size() == 2);
  CHECK(holds(refused(kMap + kRobot + "model = \"two.toml\"\n" + kFront), "the model has 2 scanners"));
}

TEST_CASE("each scanner sees from its own mount, at its own rate and by a clock of its own") {
  Scenario scenario = parsed(kHead + kFront + kRear);
  scenario.model.laser.noise_m = scenario.model.other_lasers[0].noise_m = 0.0;
  const std::vector<std::set<Time>> seen = stamps(scenario);
  CHECK(seen[0].size() == 21);  // 10 a second, from 0 on
  CHECK(seen[1].size() == 50);
  CHECK(*seen[0].begin() == time_from_seconds(0.0));
  CHECK(*seen[1].begin() == time_from_seconds(0.02));  // half of its period later
  Simulation sim(scenario, 1);
  Hal hal = sim.hal();
  hal.clock.sleep_until(time_from_seconds(0.1));
  const LaserScan front = hal.laser.latest(), rear = hal.other_lasers[0]->latest();
  CHECK(front.range_m[front.beam_count / 2] == Approx(4.8));                      // to the wall ahead
  CHECK(rear.range_m[rear.beam_count / 2] == Approx(4.8 / std::cos(kPi - 3.1)));  // and behind
}

TEST_CASE("the noise of each is its own, and a fault is that scanner's alone") {
  Scenario scenario = parsed(kHead + kFront + kRear);
  scenario.model.other_lasers[0] = scenario.model.laser;
  scenario.faults = {{.at_s = 1.0, .for_s = 10.0, .kind = FaultKind::kScanStale, .scanner = 2}};
  const std::vector<std::set<Time>> seen = stamps(scenario);
  CHECK(seen[0].size() == 21);
  CHECK(seen[1].size() == 10);
  Simulation sim(scenario, 1);
  Hal hal = sim.hal();
  hal.clock.sleep_until(time_from_seconds(0.1));
  CHECK(hal.laser.latest().range_m[400] != hal.other_lasers[0]->latest().range_m[400]);
}

TEST_CASE("with a second scanner the first sees what it sees alone") {
  Scenario one = parsed(kHead + kFront), two = parsed(kHead + kFront + kRear);
  for (Scenario* scenario : {&one, &two}) scenario->wanderers = {{.count = 4}};
  Simulation alone(one, 3), beside(two, 3);
  Hal a = alone.hal(), b = beside.hal();
  a.clock.sleep_until(time_from_seconds(2.0)), b.clock.sleep_until(time_from_seconds(2.0));
  CHECK(a.laser.latest().range_m == b.laser.latest().range_m);
}
