#include "hal/sim/simulation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "tests/sim/made_worlds.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::sim;

namespace {

/// Everything that a run could show, as numbers: truth, scans, wheels, fixes.
std::vector<double> story(const Scenario& scenario, std::uint64_t seed) {
  Simulation sim(scenario, seed);
  Hal hal = sim.hal();
  std::vector<double> numbers;
  drive(sim, 3.0, 3.2, 20.0, [&] {
    const Truth& t = sim.truth();
    numbers.insert(numbers.end(), {t.map_from_robot.x, t.map_from_robot.y, t.map_from_robot.heading, t.clearance_m});
    for (const MoverTruth& m : t.movers) numbers.insert(numbers.end(), {m.position.x, m.position.y, m.heading});
    const LaserScan& scan = hal.laser.latest();
    for (std::size_t b = 0; b < scan.beam_count; ++b) numbers.push_back(static_cast<double>(scan.range_m[b]));
    numbers.push_back(hal.drive.latest().left_rad);
    for (const ObservedMover& m : hal.pose_source.latest().movers) numbers.push_back(m.position_in_map.x);
  });
  return numbers;
}

std::vector<Vec2> mover_story(const Scenario& scenario) {
  Simulation sim(scenario, 1);
  std::vector<Vec2> places;
  drive(sim, 0.0, 0.0, 20.0, [&] {
    for (const MoverTruth& m : sim.truth().movers) places.push_back(m.position);
  });
  return places;
}

}  // namespace

TEST_CASE("the same seed tells the same story to the last bit, another seed another") {
  Scenario scenario = load_scenario(JAYWALK_OWN_SCENARIOS "/map1_04.toml");
  scenario.pose_source.enabled = true;
  const auto first = story(scenario, 1);
  CHECK(first == story(scenario, 1));
  CHECK(first != story(scenario, 2));
}

TEST_CASE("more beams, noise and outside fixes do not change what the movers do") {
  Scenario scenario = load_scenario(JAYWALK_OWN_SCENARIOS "/map1_16.toml");
  const auto plain = mover_story(scenario);
  scenario.model.laser.beams = 181;
  scenario.model.laser.noise_m = 0.05;
  scenario.pose_source.enabled = true;
  CHECK(plain == mover_story(scenario));
}

TEST_CASE("time stands still until the controller sleeps, then moves by whole steps of 2 ms") {
  Simulation sim(in_room(), 1);
  Hal hal = sim.hal();
  CHECK(hal.clock.now() == Time{});
  hal.clock.sleep_until(time_from_seconds(0.02));
  CHECK(hal.clock.now() == time_from_seconds(0.02));
  hal.clock.sleep_until(time_from_seconds(0.01));
  CHECK(hal.clock.now() == time_from_seconds(0.02));
  hal.clock.sleep_until(time_from_seconds(0.0213));
  CHECK(hal.clock.now() == time_from_seconds(0.022));
}

TEST_CASE("each device has its own rate: 151 scans, 1001 readings and 51 fixes from 0 to 10 s") {
  Scenario scenario = in_room();
  Simulation silent(scenario, 1);
  scenario.pose_source.enabled = true;
  Simulation sim(scenario, 1);
  drive(silent, 0.0, 0.0, 10.0);
  drive(sim, 0.0, 0.0, 10.0);
  CHECK(sim.hal().laser.latest().sequence == 151);
  CHECK(sim.hal().drive.latest().sequence == 1001);
  CHECK(sim.hal().pose_source.latest().sequence == 51);
  CHECK(silent.hal().pose_source.latest().sequence == 0);
}

TEST_CASE("a scan that was handed out stays as it is while the world moves on") {
  Simulation sim(in_room(), 1);
  const LaserScan& scan = sim.hal().laser.latest();
  const float first = scan.range_m[0];
  sim.hal().clock.sleep_until(time_from_seconds(1.0));
  CHECK(scan.sequence == 1);
  CHECK(scan.range_m[0] == first);
}

TEST_CASE("outside fixes are as noisy as asked: 5 cm for movers, 3 cm and 0.01 rad for the robot") {
  Scenario scenario = in_room();
  scenario.pose_source = {.enabled = true, .rate_hz = 50.0};
  scenario.wanderers.push_back({.count = 1, .speed_mps = 0.0});
  Simulation sim(scenario, 1);
  double robot = 0.0, heading = 0.0, mover = 0.0;
  int count = 0;
  drive(sim, 0.0, 0.0, 100.0, [&] {
    const OutsideFix& fix = sim.hal().pose_source.latest();
    REQUIRE(fix.movers.size() == 1);
    const auto square = [](double x) { return x * x; };
    robot += square(fix.map_from_robot.x - 5.0);
    heading += square(fix.map_from_robot.heading);
    mover += square(fix.movers[0].position_in_map.y - sim.truth().movers[0].position.y);
    ++count;
  });
  CHECK(std::sqrt(robot / count) == Approx(0.03).epsilon(0.03));  // three times 1 / sqrt(10000), 5000 fixes
  CHECK(std::sqrt(heading / count) == Approx(0.01).epsilon(0.03));
  CHECK(std::sqrt(mover / count) == Approx(0.05).epsilon(0.03));
}

TEST_CASE("the panel shows the goal") {
  Simulation sim(in_room(), 1);
  const OperatorInput input = sim.hal().panel.latest();
  CHECK(input.has_goal);
  CHECK(input.goal_in_map == Vec2{8.0, 8.0});
  CHECK_FALSE(input.emergency_stop);
}

TEST_CASE("a wall stops the robot, pushing on is one contact, coming back another") {
  Simulation sim(in_room(), 1);
  drive(sim, 6.0, 6.0, 12.0);  // 0.585 m/s for the 4.79 m to the wall
  const Truth& truth = sim.truth();
  CHECK(truth.contacts == 1);
  CHECK(truth.contacts_caused == 1);
  CHECK(truth.clearance_m == 0.0);
  CHECK(truth.map_from_robot.x == Approx(10.0 - 0.21).margin(0.01));
  drive(sim, 6.0, 6.0, 2.0);
  CHECK(truth.contacts == 1);
  drive(sim, -3.0, -3.0, 1.0);
  CHECK(truth.clearance_m > 0.15);
  drive(sim, 6.0, 6.0, 3.0);
  CHECK(truth.contacts == 2);
}

TEST_CASE("a wheelchair that turns beside a wall is stopped before its nose goes through") {
  Scenario scenario = in_room();
  scenario.model = wheelchair();
  scenario.start = {5.0, 0.5, 0.0};  // 0.175 m beside the lower wall
  Simulation sim(scenario, 1);
  const Walls walls = room();
  double least = 1.0;
  drive(sim, 2.0, -2.0, 3.0,
        [&] { least = std::min(least, walls.clearance(scenario.model.footprint, sim.truth().map_from_robot)); });
  CHECK(sim.truth().contacts == 1);
  CHECK(sim.truth().contacts_caused == 1);  // turning is motion
  CHECK(least > 0.0);
  CHECK(least < 0.01);
}

TEST_CASE("clearance is from footprint to wall, and without movers theirs is infinite") {
  Simulation sim(in_room(), 1);
  CHECK(sim.truth().clearance_m == Approx(5.0 - 0.301));
  CHECK(sim.truth().mover_clearance_m == std::numeric_limits<double>::infinity());
}

TEST_CASE("a recorded person who walks into the standing robot is a contact that it did not cause") {
  Scenario scenario = in_room();
  scenario.recorded.push_back(
      {.file = folder().write("walk.csv", "t_s,id,x_m,y_m\n0,1,1,5\n8,1,9,5\n"), .radius_m = 0.25});
  Simulation sim(scenario, 1);
  drive(sim, 0.0, 0.0, 3.0);
  CHECK(sim.truth().contacts == 0);
  CHECK(sim.truth().mover_clearance_m == Approx(1.0 - 0.25 - 0.301));
  drive(sim, 0.0, 0.0, 1.0);
  CHECK(sim.truth().contacts == 1);
  CHECK(sim.truth().mover_clearance_m == 0.0);
  drive(sim, 0.0, 0.0, 3.0);
  CHECK(sim.truth().contacts == 1);
  CHECK(sim.truth().contacts_caused == 0);
  CHECK(sim.truth().forced_movers == 1);
}

TEST_CASE("acceleration is that of the drive: 1.5 m/s2 while it spins up") {
  Simulation sim(in_room(), 1);
  drive(sim, 14.0, 14.0, 0.2);
  CHECK(sim.truth().accel_mps2 == Approx(1.5));
}

TEST_CASE("a robot that is carried is put down where the scenario says, and its wheels stand") {
  Scenario scenario = in_room();
  scenario.faults.push_back({.at_s = 1.0, .for_s = 2.0, .kind = FaultKind::kCarried, .way = {0.4, -0.2, 1.0}});
  Simulation sim(scenario, 1);
  const Pose2 from = sim.truth().map_from_robot, there = from * Pose2{0.4, -0.2, 1.0};
  drive(sim, 0.0, 0.0, 2.0);
  CHECK(distance(sim.truth().map_from_robot.position(), from * Vec2{0.2, -0.1}) < 0.002);
  drive(sim, 0.0, 0.0, 2.0);
  CHECK(distance(sim.truth().map_from_robot.position(), there.position()) < 0.002);
  CHECK(std::fabs(wrap_angle(sim.truth().map_from_robot.heading - there.heading)) < 0.002);
  CHECK(sim.hal().drive.latest().left_rad == 0.0);
  CHECK(sim.truth().contacts == 0);
}

TEST_CASE("faults last as long as they are told") {
  const auto with_fault = [&](FaultKind kind) {
    Scenario scenario = in_room();
    scenario.faults.push_back({.at_s = 1.0, .for_s = 0.5, .kind = kind});
    return scenario;
  };
  SECTION("no scans") {
    Simulation sim(with_fault(FaultKind::kScanStale), 1);
    drive(sim, 0.0, 0.0, 1.48);
    CHECK(age(sim.hal().laser.latest().stamp, sim.hal().clock.now()) > duration_from_seconds(0.48));
    drive(sim, 0.0, 0.0, 0.1);
    CHECK(age(sim.hal().laser.latest().stamp, sim.hal().clock.now()) < duration_from_seconds(0.1));
  }
  SECTION("scans full of NaN") {
    Simulation sim(with_fault(FaultKind::kScanNan), 1);
    drive(sim, 0.0, 0.0, 1.2);
    CHECK(std::isnan(sim.hal().laser.latest().range_m[100]));
    drive(sim, 0.0, 0.0, 0.4);
    CHECK(sim.hal().laser.latest().is_hit(100));
  }
  SECTION("scans cut to half") {
    Simulation sim(with_fault(FaultKind::kScanShort), 1);
    drive(sim, 0.0, 0.0, 1.2);
    CHECK(sim.hal().laser.latest().beam_count == 405);
    drive(sim, 0.0, 0.0, 0.4);
    CHECK(sim.hal().laser.latest().beam_count == 811);
  }
  SECTION("beams lost ahead") {
    Simulation sim(with_fault(FaultKind::kBeamsLost), 1);
    drive(sim, 0.0, 0.0, 1.2);
    const LaserScan lost = sim.hal().laser.latest();
    // 811 beams, a third of a degree apart, the 405th ahead: 60 degrees to each side are 180 beams.
    for (std::size_t k = 0; k < 811; ++k) REQUIRE((lost.state(k) == BeamState::kUnknown) == (k >= 225 && k <= 585));
    drive(sim, 0.0, 0.0, 0.4);
    for (std::size_t k = 0; k < 811; ++k) REQUIRE(sim.hal().laser.latest().state(k) != BeamState::kUnknown);
  }
  SECTION("one scan again and again") {
    Simulation sim(with_fault(FaultKind::kScanFrozen), 1);
    drive(sim, 1.0, 1.0, 1.1);
    const LaserScan frozen = sim.hal().laser.latest();
    drive(sim, 1.0, 1.0, 0.3);
    CHECK(sim.hal().laser.latest().range_m == frozen.range_m);
    CHECK(sim.hal().laser.latest().sequence > frozen.sequence);
    CHECK(sim.hal().laser.latest().stamp > frozen.stamp);
    drive(sim, 1.0, 1.0, 0.2);
    CHECK(sim.hal().laser.latest().range_m != frozen.range_m);
  }
  SECTION("no encoder readings") {
    Simulation sim(with_fault(FaultKind::kWheelsStale), 1);
    drive(sim, 0.0, 0.0, 1.48);
    CHECK(age(sim.hal().drive.latest().stamp, sim.hal().clock.now()) > duration_from_seconds(0.48));
    drive(sim, 0.0, 0.0, 0.1);
    CHECK(age(sim.hal().drive.latest().stamp, sim.hal().clock.now()) <= duration_from_seconds(0.01));
  }
  SECTION("a wheel without grip") {
    Simulation sim(with_fault(FaultKind::kWheelSlip), 1);
    drive(sim, 2.0, 2.0, 1.4);
    CHECK(sim.truth().twist.w_radps > 0.3);
    drive(sim, 2.0, 2.0, 0.2);
    CHECK(std::fabs(sim.truth().twist.w_radps) < 0.05);
  }
  SECTION("the red button") {
    Simulation sim(with_fault(FaultKind::kEmergencyStop), 1);
    CHECK_FALSE(sim.hal().panel.latest().emergency_stop);
    drive(sim, 0.0, 0.0, 1.2);
    CHECK(sim.hal().panel.latest().emergency_stop);
    drive(sim, 0.0, 0.0, 0.4);
    CHECK_FALSE(sim.hal().panel.latest().emergency_stop);
  }
}

TEST_CASE("worlds that cannot be are refused") {
  const auto complaint = [&](Pose2 start, Vec2 goal) {  // the room is 10 m x 10 m
    Scenario scenario = in_room();
    scenario.start = start;
    scenario.start_place = "s.toml:4: ";
    scenario.goal = goal;
    scenario.goal_place = "s.toml:5: ";
    return refusal_of([&] { const Simulation sim(scenario, 1); });
  };
  CHECK(holds(complaint({9.9, 5.0, 0.0}, {8.0, 8.0}), "s.toml:4: the robot's start lies in a wall of "));
  CHECK(holds(complaint({5.0, 5.0, 0.0}, {10.0, 5.0}), "s.toml:5: the goal lies in a wall"));
  CHECK(holds(complaint({60.1, 5.0, 0.0}, {8.0, 8.0}), "s.toml:4: the robot's start lies more than 50 m outside"));
  CHECK(holds(complaint({5.0, 5.0, 0.0}, {8.0, -1e300}), "s.toml:5: the goal lies more than 50 m outside"));
  CHECK(complaint({5.0, 5.0, 0.0}, {8.0, -49.9}).empty());
}

TEST_CASE("a thousand busy ticks ask nothing of the heap") {
  Scenario scenario = load_scenario(JAYWALK_OWN_SCENARIOS "/map1_16.toml");
  scenario.pose_source.enabled = true;
  Simulation sim(scenario, 1);
  Hal hal = sim.hal();
  const AllocationGuard guard;
  for (int k = 1; k <= 1000; ++k) {
    static_cast<void>(hal.laser.latest());
    static_cast<void>(hal.pose_source.latest());
    hal.drive.command({hal.clock.now(), 4.0, 4.1});
    hal.clock.sleep_until(time_from_seconds(0.02 * k));
  }
  const auto calls = guard.calls();
  CHECK(calls == 0);
}
