#include "firmware/robot/operator_desk.h"

#include <cmath>
#include <string>

#include "tests/drivers/hand_clock.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

/// A desk, and the loop behind it as far as a test tells.
struct Bench {
  explicit Bench(const GoalRules& rules = {0.25, 0.05}) : goal_rules(rules) {
    tell([](RunStatus&) {});
  }
  template <class Change>
  void tell(Change change) {
    status.running = status.proved = true;
    change(status);
    desk.tell(status);
  }
  /// Takes a goal, which is the loop's then.
  bool takes(const std::string& goal) { return desk.obey(goal) == "going\n" && desk.latest().has_goal; }
  void latch() {
    tell([](RunStatus& s) { s.latched = true, s.reasons = Reason::kLatched | Reason::kDrive; });
  }
  void unlatch() {
    tell([](RunStatus& s) { s.latched = false, s.reasons = Reason::kNone; });
  }

  tests::HandClock clock;
  GoalRules goal_rules;
  int restarts = 0;
  std::string restart_fails;
  bool bus_answers = true;
  OperatorDesk desk{clock, goal_rules, [this] {
                      ++restarts;
                      if (bus_answers) tell([](RunStatus& s) { s.bus.state = CanState::kActive, s.speed_mps = 0.0; });
                      return restart_fails;
                    }};
  RunStatus status;
};

}  // namespace

TEST_CASE("a route is driven goal by goal, a stop or a fault drops the rest of it") {
  Bench bench({.places = {{"a", {{1.0, 0.0}}}, {"b", {{2.0, 0.0}}}, {"c", {{3.0, 0.0}}}}});
  OperatorDesk& desk = bench.desk;
  const auto goal_x = [&] { return desk.latest().has_goal ? desk.latest().goal_in_map.x : 0.0; };
  const auto reach = [&](bool reached) { bench.tell([&](RunStatus& s) { s.goal_reached = reached; }); };
  CHECK(desk.obey("goto a b c") == "going\n");
  CHECK(goal_x() == 1.0);
  reach(true);
  CHECK(goal_x() == 2.0);
  reach(false);
  CHECK(goal_x() == 2.0);
  reach(true);
  CHECK(goal_x() == 3.0);
  CHECK(holds(desk.obey("status"), "\ngoals_left: 1\n"));
  reach(true);
  CHECK(goal_x() == 0.0);
  reach(true);  // it goes on standing there
  CHECK(goal_x() == 0.0);
  reach(false);

  CHECK(desk.obey("goto a b") == "going\n");
  CHECK(goal_x() == 1.0);
  CHECK(desk.obey("stop") == "stopping\n");
  CHECK(goal_x() == 0.0);
  CHECK_FALSE(desk.latest().emergency_stop);
  reach(false);  // a tick, at rest
  CHECK(desk.obey("goto a b") == "going\n");
  CHECK(goal_x() == 1.0);
  bench.latch();
  bench.unlatch();
  CHECK(goal_x() == 0.0);
  CHECK(desk.obey("goto attic").starts_with("refused: goto: there is no place attic"));
}

TEST_CASE("a route with a goal in a keep-out zone, or too near one, is refused") {
  const MapZone zone{ZoneKind::kKeepOut, {{1.0, 1.0}, {2.0, 1.0}, {2.0, 2.0}, {1.0, 2.0}}, 0.0};
  Bench bench({.places = {{"a", {{0.0, 0.0}}}, {"b", {{1.5, 1.5}}}}, .zones = {zone}, .body_m = 0.2});
  OperatorDesk& desk = bench.desk;
  CHECK(desk.obey("goto 1.5 1.2") ==
        "refused: goto: 1.5 1.2 lies in a keep-out zone or too near one; choose another place\n");
  CHECK(desk.obey("goto 2.2 1.5").starts_with("refused: goto: "));  // 0.2 m off, and 0.25 are kept
  CHECK(desk.obey("goto a b").starts_with("refused: goto: 1.5 1.5 lies in a keep-out zone"));
  CHECK_FALSE(desk.latest().has_goal);
  CHECK(desk.obey("goto 2.5 1.5") == "going\n");
}

TEST_CASE("a person who takes the stick drops the goal, and every order to stop is counted") {
  Bench bench;
  CHECK(bench.takes("goto 1 2"));
  const std::uint32_t orders = bench.desk.latest().stop_orders;
  bench.tell([](RunStatus& s) { s.steered = true; });
  CHECK_FALSE(bench.desk.latest().has_goal);
  CHECK(holds(bench.desk.obey("status"), "state: steered\n"));
  bench.tell([](RunStatus& s) { s.steered = false; });
  CHECK_FALSE(bench.desk.latest().has_goal);
  CHECK(bench.desk.latest().stop_orders == orders);
  CHECK(bench.desk.obey("stop") == "stopping\n");
  CHECK(bench.desk.latest().stop_orders == orders + 1);
  bench.desk.close();
  CHECK(bench.desk.latest().stop_orders == orders + 2);
}

TEST_CASE("a goal that was asked for is the loop's, with its heading, and the next goal may have none") {
  Bench bench;
  CHECK_FALSE(bench.desk.latest().has_goal);
  CHECK(std::isnan(bench.desk.latest().goal_heading_rad));
  CHECK(bench.takes("goto -1 -2 -1.57"));
  CHECK(bench.desk.latest().goal_in_map == Vec2{-1.0, -2.0});
  CHECK(bench.desk.latest().goal_tolerance_m == 0.25);
  CHECK(bench.desk.latest().goal_heading_rad == -1.57);
  CHECK(bench.desk.latest().goal_heading_tolerance_rad == 0.05);
  CHECK(bench.desk.latest().wants_heading());
  CHECK(bench.desk.obey("goto 1 2") == "going\n");
  CHECK_FALSE(bench.desk.latest().wants_heading());
}

TEST_CASE("a latched fault drops the goal, refuses others, and a reset does not bring it back") {
  Bench bench;
  CHECK(bench.takes("goto 1 1"));
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
    CHECK(bench.takes("goto 1 2"));
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
  CHECK(bench.desk.obey("reset").starts_with("refused: the robot still moves"));
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
  CHECK(bench.desk.obey("reset").starts_with("refused: bus-off, and nobody"));
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
  CHECK(waits.job().starts_with("refused: stopped anew meanwhile"));
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

TEST_CASE("what is no order moves nothing, and the goal stays as it was") {
  Bench bench;
  CHECK(bench.desk.obey("goto 1 2 0.5") == "going\n");
  for (const char* line :
       {"", "goto", "goto ", "goto 1", "goto 1 2 3 4", "goto nan 0", "goto inf 1", "goto 1 1e9", "go 1 2", "status now",
        "goto 1 2;", "GOTO 1 2", "\xff\x00", "goto 3 4 90", "goto 3 4 nan", "goto 3 4 east"}) {
    CAPTURE(line);
    CHECK(bench.desk.obey(line).starts_with("refused"));
    CHECK(bench.desk.latest().goal_in_map == Vec2{1.0, 2.0});
    CHECK(bench.desk.latest().goal_heading_rad == 0.5);
  }
}

TEST_CASE("before the loop runs and after it was told to end there are no goals, and before it no proof") {
  tests::HandClock clock;
  OperatorDesk desk(clock, {}, [] { return std::string(); });
  CHECK(desk.obey("goto 1 1").starts_with("refused: the robot is not ready"));
  CHECK(holds(desk.obey("status"), "\ndrives_proved: no\n"));
  Bench bench;
  CHECK(bench.desk.obey("goto 1 1") == "going\n");
  bench.desk.close();
  CHECK_FALSE(bench.desk.latest().has_goal);
  CHECK(bench.desk.obey("goto 1 1").starts_with("refused: the run is ending"));
}

TEST_CASE("status is told in lines of word and value, the turn to a heading at the goal and its want of room too") {
  const auto check_status = [](void (*change)(RunStatus&), std::initializer_list<const char*> lines) {
    Bench bench;
    bench.tell(change);
    const std::string status = "\n" + bench.desk.obey("status");
    for (const char* line : lines) CHECK(holds(status, "\n" + std::string(line) + "\n"));
    CHECK(status.starts_with("\n" + std::string(*lines.begin())));
  };
  check_status([](RunStatus& s) { s.missed_ticks = 7, s.reasons = Reason::kStopZone | Reason::kNoGoal; },
               {"state: waiting", "missed_ticks: 7", "reasons: stop_zone|no_goal", "goal: "});
  check_status(
      [](RunStatus& s) {
        s.has_goal = s.turns_at_goal = true;
        s.goal_in_map = {1.5, -2.0};
        s.goal_heading_rad = 1.57;
        s.reasons = Reason::kTurnBlocked;
      },
      {"state: turning", "goal: 1.5 -2 1.57", "reasons: turn_blocked"});
}

TEST_CASE("goals are refused from an order to stop on until the robot stands, here and reset as well", "[stop]") {
  Bench bench;
  bench.tell([](RunStatus& s) { s.at_rest = false; });
  const auto refuses = [&](const char* line) { return bench.desk.obey(line).starts_with("refused"); };
  CHECK(bench.desk.obey("stop") == "stopping\n");
  CHECK(refuses("goto 1 2"));  // before the loop knows
  CHECK(refuses("here 1 2 0"));
  CHECK(refuses("reset"));
  static_cast<void>(bench.desk.latest());
  bench.tell([](RunStatus&) {});
  CHECK(refuses("goto 1 2"));
  CHECK_FALSE(bench.desk.latest().has_goal);
  bench.tell([](RunStatus& s) { s.at_rest = true; });
  CHECK(bench.takes("goto 1 2"));
}

TEST_CASE("a goal given in the tick of a stop is void", "[stop]") {
  Bench bench;
  CHECK(bench.takes("goto 1 2"));
  bench.tell([](RunStatus&) {});
  CHECK(bench.desk.obey("goto 3 4") == "going\n");
  CHECK(bench.desk.obey("stop") == "stopping\n");
  CHECK_FALSE(bench.desk.latest().has_goal);
  CHECK_FALSE(bench.desk.latest().has_goal);
}

TEST_CASE("a goal that is being repeated is void from a stop on until it was left unsaid for 5 s", "[stop]") {
  SaidGoals goals;
  const auto is_void = [&](const char* words, std::uint32_t revoked, Duration at) {
    return goals.is_void(words, revoked, Time{at});
  };
  CHECK_FALSE(is_void("a", 0, 1s));
  CHECK_FALSE(is_void("a", 0, 2s));
  CHECK_FALSE(is_void("once", 0, 2s));
  CHECK(is_void("a", 1, 3s));
  CHECK_FALSE(is_void("once", 1, 3s));
  CHECK_FALSE(is_void("b", 1, 3s));
  CHECK(is_void("a", 1, 8s));
  CHECK(is_void("a", 2, 13s));
  CHECK_FALSE(is_void("a", 2, 18s + 1ns));
  CHECK_FALSE(is_void("a", 2, 19s));
  for (int k = 0; k < 1000; ++k) CHECK_FALSE(is_void(std::to_string(k).c_str(), 2, 19s));  // a flood forgets some
}

TEST_CASE("a reset is refused by the name of a fault that still shows, and not for what it ends itself", "[stop]") {
  Bench bench;
  bench.tell([](RunStatus& s) { s.latched = true, s.reasons = Reason::kLatched | Reason::kMotionMismatch; });
  CHECK(bench.desk.obey("reset") == "refused: still motion_mismatch; see to it, then jaywalk reset\n");
  CHECK_FALSE(bench.desk.latest().reset);
  bench.tell([](RunStatus& s) { s.reasons = Reason::kLatched | Reason::kDrive | Reason::kStopZone; });
  CHECK(bench.desk.obey("reset") == "reset\n");
  CHECK(bench.desk.latest().reset);
}

TEST_CASE("a dead man whose link may die unnoticed is refused at start with what to do about it") {
  panel::JoystickState state;
  state.connected = state.needs_renewal = true;
  panel::JoystickSetup wiring{.path = "/dev/input/pad"};
  CHECK_THROWS_WITH(refuse_unrenewed(state, wiring),
                    "/dev/input/pad: is on Bluetooth, whose link may die with the dead man held; give [panel] "
                    "dead_man_renew_s, 2 say, or use a cable");
  wiring.needs_dead_man = false;
  CHECK_NOTHROW(refuse_unrenewed(state, wiring));
  state.needs_renewal = false;
  wiring.needs_dead_man = true;
  CHECK_NOTHROW(refuse_unrenewed(state, wiring));
}
