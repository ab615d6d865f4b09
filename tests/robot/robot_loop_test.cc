#include "firmware/robot/robot_loop.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/report/run_observer.h"
#include "firmware/backends.h"
#include "hil/far_end/simulated_robot.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

RobotFile wiring() {
  RobotFile file = load_robot_file(std::string(JAYWALK_RIG) + "/drive/robot.toml");
  file.setup.backend = Backend::kCpu;
  return file;
}

ChosenPlanner in_thread(const ControlSetup& setup) {
  static TickObserver nobody;
  ChosenPlanner chosen = make_planner(setup);
  chosen.planner = std::make_unique<PlannerThread>(std::move(chosen.planner), map_for(setup), nobody);
  return chosen;
}

}  // namespace

TEST_CASE("a loop that is prepared and never started lives through no tick") {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("jaywalk_given_up_" + std::to_string(::getpid()));
  {
    rig::HandLivingClock clock;
    rig::InProcessRobot robot(wiring(), sim::load_scenario(std::string(JAYWALK_RIG) + "/drive/hall.toml"), 3, clock,
                              {folder});
    CHECK(robot.loop().prepare({.priority = 0}).empty());
    CHECK_FALSE(robot.loop().has_ended());
    CHECK(robot.loop().traces().front() == nullptr);
  }
  std::filesystem::remove_all(folder);
}

// In real time, with every thread that a run has. Nothing here depends on this machine's being in time: a tick that is
// missed latches, and ends all the same.
TEST_CASE("the loop's thread tells of its ticks, and ramps to rest and disarms when it is told to end") {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("jaywalk_robot_loop_" + std::to_string(::getpid()));
  {
    rig::RealLivingClock clock;
    RunObserver observer;
    rig::InProcessRobot robot(wiring(), sim::load_scenario(std::string(JAYWALK_RIG) + "/drive/hall.toml"), 3, clock,
                              {folder, in_thread, &observer});
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
        asked = said == "going\n" || said.rfind("refused: stopped by missed_ticks", 0) == 0;
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
    const auto summary = nlohmann::json::parse(std::ifstream(folder / "summary.json"));
    for (const char* key : {"wake_late_us", "tick_us"}) {
      for (const char* figure : {"p50", "p99", "p99.9", "max"}) CHECK(summary[key][figure].is_number());
      std::uint64_t counted = 0;
      for (const auto& bin : summary[key]["bins"]) counted += bin[1].get<std::uint64_t>();
      CHECK(counted == loop.times().tick_us.count());
    }
    CHECK(summary["page_faults"]["major"].is_number());
    CHECK(robot.far_end().drive(0).state_name() != "enabled");
  }
  std::filesystem::remove_all(folder);
}
