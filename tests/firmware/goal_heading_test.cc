// Drives to a goal with a heading, simulated.
#include <cmath>
#include <filesystem>

#include "tests/firmware/relived.h"
#include "tests/firmware/simulated_drive.h"
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

namespace {

/// How a robot comes to a goal `ahead_m` before the door's room's far wall, which is its heading too.
struct Coming {
  double past_m = -1.0;  ///< it went beyond the goal
  int reversals = 0;
  bool arrived = false;
};

Coming come_to(const RobotModel& model, double from_wall_m, double start_y) {
  constexpr double kWall_m = 8.4;
  const double goal_x = kWall_m - from_wall_m;
  SimulatedDrive drive("door", 1, [&](sim::Scenario& s) {
    s.model = model;
    s.start = {5.0, start_y, 0.0};
    s.goal = {goal_x, 2.6};
    s.goal_heading_rad = 0.0;
  });
  Coming coming;
  double gear = 1.0;
  coming.arrived = drive.drive(20.0, [&](const TickRecord& t) {
    const double v = drive.truth().twist.v_mps;
    coming.past_m = std::max(coming.past_m, drive.truth().map_from_robot.x - goal_x);
    if (std::fabs(v) > 0.02 && v * gear < 0.0) ++coming.reversals, gear = -gear;
    return is_there(drive, t.input);
  });
  CHECK(drive.truth().contacts == 0);
  return coming;
}

}  // namespace

TEST_CASE("a goal with its heading straight ahead is not driven past, a wall half a metre before the body or none") {
  const RobotModel model = GENERATE(p3dx(), wheelchair());
  const double room_m = GENERATE(0.5, 1.0);
  const double start_y = GENERATE(2.6, 2.4);
  CAPTURE(model.name, room_m, start_y);
  const Coming coming = come_to(model, model.footprint.front_m + room_m, start_y);
  CHECK(coming.arrived);
  CHECK(coming.past_m < 0.15);
  CHECK(coming.reversals <= 1);
}

TEST_CASE("where the body has no room as it is to stand at the goal, the robot stands and the plan has no path") {
  SimulatedDrive drive("door", 1, [](sim::Scenario& s) {
    s.start = {5.0, 2.6, 0.0};
    s.goal = {8.0, 2.6};
    s.goal_heading_rad = 0.0;
  });
  double fastest = 0.0;
  PlanStatus status = PlanStatus::kNone;
  drive.drive(8.0);  // it may leave the wall behind it
  drive.drive(20.0, [&](const TickRecord& t) {
    fastest = std::max(fastest, std::fabs(drive.truth().twist.v_mps));
    status = t.plan_status;
    return false;
  });
  CHECK(fastest < 0.05);
  CHECK(status == PlanStatus::kNoPath);
}

TEST_CASE("a wheelchair that is to look out of a dead end that it cannot turn in backs out, turns and backs in") {
  SimulatedDrive drive("dead_end", 1, [](sim::Scenario& s) {
    s.start = {3.0, 2.6, 0.0};
    s.goal = {6.6, 2.6};
    s.goal_heading_rad = kPi;
  });
  bool turns = false;
  CHECK(drive.drive(90.0, [&](const TickRecord& t) {
    turns = turns || drive.loop().motion().status().turns_at_goal;
    return is_there(drive, t.input) || drive.truth().contacts > 0;
  }));
  CHECK(turns);
  CHECK(drive.truth().contacts == 0);
}

TEST_CASE("a robot that keeps its speed does not turn at the goal") {
  const auto to_look_back = [](sim::Scenario& s) {
    s.model = p3dx();
    s.start = {6.0, 4.1, 0.0};
    s.goal_heading_rad = kPi;
  };
  SimulatedDrive drive("door", 1, to_look_back, PlanMode::kPaper);
  CHECK(drive.drive(10.0, [&](const TickRecord&) { return drive.to_goal_m() < 0.1; }));
  CHECK_FALSE(drive.loop().motion().status().turns_at_goal);
  CHECK(drive.truth().twist.v_mps > 0.5);
}

TEST_CASE("turning at the goal asks nothing of the heap and replays to the same commands, bit for bit") {
  const std::string file = (std::filesystem::temp_directory_path() / "jaywalk_goal_heading.jwr").string();
  int turning = 0;
  {
    const auto to_look_back = [](sim::Scenario& s) {
      s.start = {6.2, 4.1, 0.0};
      s.goal_heading_rad = kPi;
    };
    SimulatedDrive drive("door", 1, to_look_back, PlanMode::kFull, file);
    CHECK(drive.heap_calls(50 * 12, [&](const TickRecord&) {
      turning += drive.loop().motion().status().turns_at_goal && drive.truth().twist.w_radps != 0.0 ? 1 : 0;
    }) == 0);
    REQUIRE(drive.recorder().close());
  }
  CHECK(turning > 50);
  const Relived relived = relive(file);
  CHECK(relived.ticks == 600);
  CHECK(relived.different == 0);
}
