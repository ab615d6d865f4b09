#include "firmware/robot/robot_loop.h"

#include <nlohmann/json.hpp>

#include "apps/report/run_observer.h"
#include "firmware/backends.h"
#include "tests/robot/wired_bench.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

ChosenPlanner in_thread(const ControlSetup& setup) {
  static TickObserver nobody;
  ChosenPlanner chosen = make_planner(setup);
  chosen.planner = std::make_unique<PlannerThread>(std::move(chosen.planner), map_for(setup), nobody);
  return chosen;
}

}  // namespace

TEST_CASE("a loop that is prepared and never started lives through no tick") {
  tests::WiredBench bench("robot");
  RobotLoop& loop = bench.robot.loop();
  CHECK(loop.prepare({.priority = 0}).empty());
  CHECK_FALSE(loop.has_ended());
  CHECK(loop.traces().front() == nullptr);
}

// In real time, with every thread that a run has. Nothing here depends on this machine's being in time: a tick that is
// missed latches, and ends all the same.
TEST_CASE("the loop's thread tells of its ticks, and ramps to rest and disarms when it is told to end") {
  const Scratch scratch;
  rig::RealLivingClock clock;
  RunObserver observer;
  rig::InProcessRobot robot(tests::robot_in(scratch.folder(), tests::rig_file("robot")),
                            sim::load_scenario(tests::rig_file("hall")), 3, clock,
                            {scratch.folder(), in_thread, &observer});
  clock.live = [&robot] { robot.step_far_end(); };
  robot.laser().start();
  while (robot.laser().latest().sequence == 0) clock.sleep_until(clock.now() + 1ms);
  RobotLoop& loop = robot.loop();
  CHECK(loop.prepare({.priority = 0}).empty());
  CHECK(loop.traces().front() == nullptr);
  static_cast<void>(robot.drive().arm());
  // From here on the loop's thread alone sleeps by the clock.
  SteadyClock mine;
  loop.start();
  std::uint64_t ticks = 0;
  bool asked = false;
  while (!loop.has_ended()) {
    mine.sleep_until(mine.now() + 5ms);
    robot.runner().drain();
    for (; loop.traces().front() != nullptr; loop.traces().pop()) ticks = loop.traces().front()->status.ticks;
    if (ticks > 5 && !asked) {
      const std::string said = robot.desk().obey("goto 9 8");
      asked = said == "going\n" || said.starts_with("refused: stopped by missed_ticks");
    }
    if (ticks > 100) loop.end();
  }
  CHECK(asked);
  CHECK(ticks > 100);
  CHECK_FALSE(robot.drive().is_enabled());
  CHECK(robot.far_end().rim_speed() == 0.0);
  CHECK(loop.times().tick_us.count() == loop.times().wake_late_us.count());
  CHECK(loop.times().tick_us.count() > 100);
  CHECK(loop.times().tick_us.max() > 0.0);
  robot.runner().finish({.outcome = "stopped", .loop_times = &loop.times()});
  const auto summary = nlohmann::json::parse(scratch.read("summary.json"));
  for (const char* key : {"wake_late_us", "tick_us"}) {
    for (const char* figure : {"p50", "p99", "p99.9", "max"}) CHECK(summary[key][figure].is_number());
    std::uint64_t counted = 0;
    for (const auto& bin : summary[key]["bins"]) counted += bin[1].get<std::uint64_t>();
    CHECK(counted == loop.times().tick_us.count());
  }
  CHECK(summary["page_faults"]["major"].is_number());
  CHECK(robot.far_end().drive(0).state_name() != "enabled");
}
