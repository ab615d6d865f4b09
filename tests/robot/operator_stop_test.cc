// Orders to stop at the desk: what counts after them, and from when on.
#include "firmware/robot/goal_order.h"
#include "tests/robot/desk_bench.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;
using Bench = tests::DeskBench;

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
  CHECK(bench.desk.obey("goto 1 2") == "going\n");
  CHECK(bench.desk.latest().has_goal);
}

TEST_CASE("a goal given in the tick of a stop is void", "[stop]") {
  Bench bench;
  CHECK(bench.desk.obey("goto 1 2") == "going\n");
  CHECK(bench.desk.latest().has_goal);
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
