// Drives to a goal with a heading, simulated.
#include <cmath>
#include <filesystem>

#include "tests/firmware/relived.h"
#include "tests/firmware/simulated_drive.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// The true robot stands at the goal, with the heading.
bool is_there(const SimulatedDrive& drive, const OperatorInput& input) {
  const Twist2 twist = drive.truth().twist;
  return input.is_reached_at(drive.truth().map_from_robot) && std::fabs(twist.v_mps) < 0.01 &&
         std::fabs(twist.w_radps) < 0.02;
}

/// Comes to stand at the goal with the heading, without touching anything.
void check_arrives(const std::string& scenario, const RobotModel& model, double heading, double limit_s) {
  INFO(scenario << " " << model.name << " heading " << heading);
  SimulatedDrive drive(scenario, 1, [&](sim::Scenario& s) {
    s.model = model;
    s.goal_heading_rad = heading;
  });
  CHECK(drive.drive(limit_s,
                    [&](const TickRecord& t) { return is_there(drive, t.input) || drive.truth().contacts > 0; }));
  CHECK(drive.truth().contacts == 0);
  // And stays so.
  bool moved = false;
  drive.drive(1.0, [&](const TickRecord& t) { return moved = moved || !is_there(drive, t.input); });
  CHECK_FALSE(moved);
}

}  // namespace

TEST_CASE("a nearly round robot turns to look back where it came from, or to either side") {
  for (const double heading : {kPi, kPi / 2.0, -kPi / 2.0}) check_arrives("door", p3dx(), heading, 40.0);
}

TEST_CASE("a wheelchair turns to look back where it came from") {
  check_arrives("door", wheelchair(), kPi, 120.0);
  check_arrives("dead_end", wheelchair(), 0.0, 90.0);
}

TEST_CASE("a wheelchair that is to look out of a dead end that it cannot turn in backs out, turns and backs in") {
  SimulatedDrive drive("dead_end", 1, [](sim::Scenario& s) {
    s.start = {3.0, 2.6, 0.0};
    s.goal = {6.6, 2.6};
    s.goal_heading_rad = kPi;
  });
  bool turns = false;
  CHECK(drive.drive(90.0, [&](const TickRecord& t) {
    turns = turns || drive.loop().turns_at_goal();
    return is_there(drive, t.input) || drive.truth().contacts > 0;
  }));
  CHECK(turns);
  CHECK(drive.truth().contacts == 0);
}

TEST_CASE("a robot that keeps its speed does not turn at the goal") {
  SimulatedDrive drive(
      "door", 1,
      [](sim::Scenario& s) {
        s.model = p3dx();
        s.start = {6.0, 4.1, 0.0};
        s.goal_heading_rad = kPi;
      },
      PlanMode::kPaper);
  CHECK(drive.drive(10.0, [&](const TickRecord&) { return drive.to_goal_m() < 0.1; }));
  CHECK_FALSE(drive.loop().turns_at_goal());
  CHECK(drive.truth().twist.v_mps > 0.5);
}

TEST_CASE("turning at the goal asks nothing of the heap and replays to the same commands, bit for bit") {
  const std::string file = (std::filesystem::temp_directory_path() / "jaywalk_goal_heading.jwr").string();
  int turning = 0;
  {
    SimulatedDrive drive(
        "door", 1,
        [](sim::Scenario& s) {
          s.start = {6.2, 4.1, 0.0};
          s.goal_heading_rad = kPi;
        },
        PlanMode::kFull, file);
    std::uint64_t calls = 0;
    for (int k = 0; k < 50 * 12; ++k) {
      drive.sleep();
      const AllocationGuard guard;
      (void)drive.tick_now();
      calls += guard.calls();
      turning += drive.loop().turns_at_goal() && drive.truth().twist.w_radps != 0.0 ? 1 : 0;
    }
    CHECK(calls == 0);
    REQUIRE(drive.recorder().close());
  }
  CHECK(turning > 50);
  const Relived relived = relive(file);
  CHECK(relived.ticks == 600);
  CHECK(relived.different == 0);
}
