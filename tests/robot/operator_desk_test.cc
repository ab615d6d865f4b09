#include <cmath>
#include <string>

#include "tests/robot/desk_bench.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using Bench = tests::DeskBench;

TEST_CASE("a goal that was asked for is the loop's until somebody says stop") {
  Bench bench;
  CHECK_FALSE(bench.desk.latest().has_goal);
  CHECK(bench.desk.obey("goto 1.5 -2") == "going\n");
  const OperatorInput input = bench.desk.latest();
  CHECK(input.has_goal);
  CHECK(input.goal_in_map == Vec2{1.5, -2.0});
  CHECK(input.goal_tolerance_m == 0.25);
  CHECK(bench.desk.obey("stop") == "stopping\n");
  CHECK_FALSE(bench.desk.latest().has_goal);
  CHECK_FALSE(bench.desk.latest().emergency_stop);
}

TEST_CASE("a route is driven goal by goal, a stop or a fault drops the rest of it") {
  tests::HandClock clock;
  OperatorDesk desk(clock, {}, [] { return std::string(); },
                    {{"a", {{1.0, 0.0}}}, {"b", {{2.0, 0.0}}}, {"c", {{3.0, 0.0}}}});
  RunStatus status;
  status.running = true;
  desk.tell(status);
  const auto goal_x = [&] { return desk.latest().has_goal ? desk.latest().goal_in_map.x : 0.0; };
  const auto reach = [&](bool reached) { status.goal_reached = reached, desk.tell(status); };
  CHECK(desk.obey("goto a b c") == "going\n");
  CHECK(goal_x() == 1.0);
  reach(true);
  CHECK(goal_x() == 2.0);
  reach(false);
  CHECK(goal_x() == 2.0);
  reach(true);
  CHECK(goal_x() == 3.0);
  CHECK(desk.obey("status").find("\ngoals_left: 1\n") != std::string::npos);
  reach(true);
  CHECK(goal_x() == 0.0);
  reach(true);  // it goes on standing there
  CHECK(goal_x() == 0.0);
  reach(false);

  CHECK(desk.obey("goto a b") == "going\n");
  CHECK(goal_x() == 1.0);
  CHECK(desk.obey("stop") == "stopping\n");
  CHECK(goal_x() == 0.0);
  reach(false);  // a tick, at rest
  CHECK(desk.obey("goto a b") == "going\n");
  CHECK(goal_x() == 1.0);
  status.latched = true, status.reasons = Reason::kLatched | Reason::kBus, desk.tell(status);
  status.latched = false, status.reasons = Reason::kNone, desk.tell(status);
  CHECK(goal_x() == 0.0);
  CHECK(desk.obey("goto attic").find("refused: goto: there is no place attic") == 0);
}

TEST_CASE("a route with a goal in a keep-out zone, or too near one, is refused") {
  tests::HandClock clock;
  const MapZone zone{ZoneKind::kKeepOut, {{1.0, 1.0}, {2.0, 1.0}, {2.0, 2.0}, {1.0, 2.0}}, 0.0};
  OperatorDesk desk(clock, {}, [] { return std::string(); }, {{"a", {{0.0, 0.0}}}, {"b", {{1.5, 1.5}}}}, {{zone}, 0.2});
  RunStatus status;
  status.running = true;
  desk.tell(status);
  CHECK(desk.obey("goto 1.5 1.2") ==
        "refused: goto: 1.5 1.2 lies in a keep-out zone or too near one; choose another place\n");
  CHECK(desk.obey("goto 2.2 1.5").find("refused: goto: ") == 0);  // 0.2 m off, and 0.25 are kept
  CHECK(desk.obey("goto a b").find("refused: goto: 1.5 1.5 lies in a keep-out zone") == 0);
  CHECK_FALSE(desk.latest().has_goal);
  CHECK(desk.obey("goto 2.5 1.5") == "going\n");
}

TEST_CASE("a person who takes the stick drops the goal, and every order to stop is counted") {
  Bench bench;
  CHECK(bench.desk.obey("goto 1 2") == "going\n");
  CHECK(bench.desk.latest().has_goal);
  const std::uint32_t orders = bench.desk.latest().stop_orders;
  bench.tell([](RunStatus& s) { s.steered = true; });
  CHECK_FALSE(bench.desk.latest().has_goal);
  CHECK(bench.desk.obey("status").find("state: steered\n") != std::string::npos);
  bench.tell([](RunStatus& s) { s.steered = false; });
  CHECK_FALSE(bench.desk.latest().has_goal);
  CHECK(bench.desk.latest().stop_orders == orders);
  CHECK(bench.desk.obey("stop") == "stopping\n");
  CHECK(bench.desk.latest().stop_orders == orders + 1);
  bench.desk.close();
  CHECK(bench.desk.latest().stop_orders == orders + 2);
}

TEST_CASE("a goal's heading is the loop's as well, and the next goal may have none") {
  Bench bench;
  CHECK(std::isnan(bench.desk.latest().goal_heading_rad));
  CHECK(bench.desk.obey("goto -1 -2 -1.57") == "going\n");
  CHECK(bench.desk.latest().goal_in_map == Vec2{-1.0, -2.0});
  CHECK(bench.desk.latest().goal_heading_rad == -1.57);
  CHECK(bench.desk.latest().goal_heading_tolerance_rad == 0.05);
  CHECK(bench.desk.latest().wants_heading());
  CHECK(bench.desk.obey("goto 1 2") == "going\n");
  CHECK_FALSE(bench.desk.latest().wants_heading());
}

TEST_CASE("a heading in degrees, none, and a word too many are refused, and the goal stays as it was") {
  Bench bench;
  CHECK(bench.desk.obey("goto 1 2 0.5") == "going\n");
  CHECK(bench.desk.obey("goto 3 4 90") ==
        "refused: goto: HEADING 90 is out of range; give radians in the map, a turn (6.2832) at most\n");
  CHECK(bench.desk.obey("goto 3 4 nan") ==
        "refused: goto: HEADING nan is not finite; give radians in the map, a turn (6.2832) at most\n");
  CHECK(bench.desk.obey("goto 3 4 east").rfind("refused: goto: HEADING east is no number; ", 0) == 0);
  CHECK(bench.desk.obey("goto 3 4 0 0") ==
        "refused: goto: 4 words make no goal; give X Y, X Y HEADING, or names of places\n");
  CHECK(bench.desk.latest().goal_in_map == Vec2{1.0, 2.0});
  CHECK(bench.desk.latest().goal_heading_rad == 0.5);
}

TEST_CASE("a goal that was reached is dropped, and the next is taken") {
  Bench bench;
  CHECK(bench.desk.obey("goto 1 1") == "going\n");
  CHECK(bench.desk.latest().has_goal);
  bench.tell([](RunStatus& s) { s.goal_reached = true; });
  CHECK_FALSE(bench.desk.latest().has_goal);
  CHECK(bench.desk.obey("goto 2 2") == "going\n");
  CHECK(bench.desk.latest().has_goal);
}

TEST_CASE("a latched fault drops the goal, refuses others, and a reset does not bring it back") {
  Bench bench;
  CHECK(bench.desk.obey("goto 1 1") == "going\n");
  CHECK(bench.desk.latest().has_goal);
  bench.latch();
  CHECK_FALSE(bench.desk.latest().has_goal);
  CHECK(bench.desk.obey("goto 1 1") == "refused: stopped by drive; see to it, then jaywalk reset\n");
  CHECK(bench.desk.obey("reset") == "reset\n");
  CHECK(bench.desk.latest().reset);
  CHECK_FALSE(bench.desk.latest().reset);  // an edge
  bench.unlatch();
  CHECK_FALSE(bench.desk.latest().has_goal);
}

TEST_CASE("a second latch after a reset is told by its reasons, and takes the goal, as the first") {
  Bench bench;
  bench.latch();
  CHECK(bench.status.latched_by == Reason::kDrive);
  for (const Reason fault : {Reason::kScanStale, Reason::kDrive}) {
    bench.unlatch();
    CHECK(bench.status.latched_by == Reason::kNone);
    CHECK(bench.desk.obey("goto 1 2") == "going\n");
    CHECK(bench.desk.latest().has_goal);
    bench.tell([&](RunStatus& s) { s.reasons = fault; });  // a tick before it latches
    bench.tell([&](RunStatus& s) { s.latched = true, s.reasons = Reason::kLatched | fault; });
    CHECK(bench.status.latched_by == fault);
    CHECK_FALSE(bench.desk.latest().has_goal);
  }
}

TEST_CASE("there is no reset on the move, and none where nothing is latched") {
  Bench bench;
  CHECK(bench.desk.obey("reset") == "nothing to reset\n");
  bench.latch();
  bench.tell([](RunStatus& s) { s.speed_mps = 0.2; });
  CHECK(bench.desk.obey("reset").rfind("refused: the robot still moves", 0) == 0);
  CHECK_FALSE(bench.desk.latest().reset);
}

TEST_CASE("a reset at bus-off restarts the bus first, and is none where that fails") {
  Bench bench;
  bench.latch();
  CHECK(bench.desk.obey("reset") == "reset\n");
  CHECK(bench.restarts == 0);
  CHECK(bench.desk.latest().reset);
  // The speed is what was felt last, on the move.
  const auto off = [](RunStatus& s) { s.bus.state = CanState::kBusOff, s.speed_mps = 0.6; };
  bench.tell(off);
  CHECK(bench.desk.obey("reset") == "reset\n");
  CHECK(bench.restarts == 1);
  CHECK(bench.desk.latest().reset);
  bench.tell(off);
  bench.restart_fails = "can0: not permitted";
  CHECK(bench.desk.obey("reset") == "refused: can0: not permitted\n");
  bench.restart_fails.clear();
  bench.bus_answers = false;
  bench.tell(off);
  CHECK(bench.desk.obey("reset").rfind("refused: bus-off, and nobody", 0) == 0);
  CHECK_FALSE(bench.desk.latest().reset);
}

TEST_CASE("a stop that comes while a reset waits for the bus is obeyed at once, and the reset is none") {
  Bench bench;
  bench.latch();
  bench.tell([](RunStatus& s) { s.bus.state = CanState::kBusOff; });
  const ControlReply waits = bench.desk.reply_to("reset");
  REQUIRE(waits.job);
  CHECK(bench.desk.reply_to("stop now").text == "stopping\n");
  CHECK(bench.desk.latest().emergency_stop);
  CHECK(waits.job().rfind("refused: stopped anew meanwhile", 0) == 0);
  CHECK_FALSE(bench.desk.latest().reset);
  CHECK(bench.desk.obey("reset") == "reset\n");  // the bus is back
  CHECK(bench.desk.latest().reset);
}

TEST_CASE("an emergency stop is pressed for a tick and takes the goal") {
  Bench bench;
  CHECK(bench.desk.obey("goto 1 1") == "going\n");
  CHECK(bench.desk.obey("stop now") == "stopping\n");
  const OperatorInput input = bench.desk.latest();
  CHECK(input.emergency_stop);
  CHECK_FALSE(input.has_goal);
  CHECK_FALSE(bench.desk.latest().emergency_stop);
}

TEST_CASE("what is no order moves nothing") {
  Bench bench;
  for (const char* line : {"", "goto", "goto ", "goto 1", "goto 1 2 3 4", "goto nan 0", "goto inf 1", "goto 1 1e9",
                           "go 1 2", "status now", "goto 1 2;", "GOTO 1 2", "\xff\x00"}) {
    CHECK(bench.desk.obey(line).rfind("refused", 0) == 0);
  }
  CHECK_FALSE(bench.desk.latest().has_goal);
}

TEST_CASE("before the loop runs and after it was told to end there are no goals") {
  tests::HandClock clock;
  OperatorDesk desk(clock, {}, [] { return std::string(); });
  CHECK(desk.obey("goto 1 1").rfind("refused: the robot is not ready", 0) == 0);
  Bench bench;
  CHECK(bench.desk.obey("goto 1 1") == "going\n");
  bench.desk.close();
  CHECK_FALSE(bench.desk.latest().has_goal);
  CHECK(bench.desk.obey("goto 1 1").rfind("refused: the run is ending", 0) == 0);
}

TEST_CASE("the loop's side of the desk asks nothing of the heap") {
  Bench bench;
  CHECK(bench.desk.obey("goto 1 1") == "going\n");
  const AllocationGuard guard;
  const bool has_goal = bench.desk.latest().has_goal;
  bench.desk.tell(bench.status);
  const auto calls = guard.calls();
  CHECK(has_goal);
  CHECK(calls == 0);
}

TEST_CASE("before the loop runs nothing is said to be proved") {
  tests::HandClock clock;
  OperatorDesk desk(clock, {}, [] { return std::string(); });
  CHECK(desk.obey("status").find("\ndrives_proved: no\n") != std::string::npos);
}

TEST_CASE("status is told in lines of word and value") {
  Bench bench;
  bench.tell([](RunStatus& s) {
    s.missed_ticks = 7;
    s.reasons = Reason::kStopZone | Reason::kNoGoal;
  });
  const std::string status = bench.desk.obey("status");
  CHECK(status.rfind("state: waiting\n", 0) == 0);
  CHECK(status.find("\nmissed_ticks: 7\n") != std::string::npos);
  CHECK(status.find("\nreasons: stop_zone|no_goal\n") != std::string::npos);
  CHECK(status.find("\ngoal: \n") != std::string::npos);
}

TEST_CASE("status tells the heading at the goal, that the robot turns to it, and that it has no room to") {
  Bench bench;
  bench.tell([](RunStatus& s) {
    s.has_goal = s.turns_at_goal = true;
    s.goal_in_map = {1.5, -2.0};
    s.goal_heading_rad = 1.57;
    s.reasons = Reason::kTurnBlocked;
  });
  const std::string status = bench.desk.obey("status");
  CHECK(status.rfind("state: turning\n", 0) == 0);
  CHECK(status.find("\ngoal: 1.5 -2 1.57\n") != std::string::npos);
  CHECK(status.find("\nreasons: turn_blocked\n") != std::string::npos);
}
