#include "firmware/robot/robot_loop.h"

#include <unistd.h>

#include <filesystem>

#include "firmware/far_end/in_process_robot.h"
#include "firmware/far_end/living_clock.h"
#include "firmware/robot/planner_thread.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

RobotFile wiring() {
  RobotFile file = load_robot_file(std::string(JAYWALK_RIG) + "/drive/robot.toml");
  file.setup.backend = Backend::kCpu;
  return file;
}

std::unique_ptr<Planner> in_thread(std::unique_ptr<Planner> planner) {
  return std::make_unique<PlannerThread>(
      std::move(planner), EvidenceMap(PerceptionConfig{}.map_side_cells, wiring().setup.planner().cell_m, {}));
}

}  // namespace

// In real time, with every thread that a run has. Nothing here depends on this machine's being in time: a tick that is
// missed latches, and ends all the same.
TEST_CASE("the loop's thread tells of its ticks, and ramps to rest and disarms when it is told to end") {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("jaywalk_robot_loop_" + std::to_string(::getpid()));
  {
    rig::RealLivingClock clock;
    rig::InProcessRobot robot(wiring(), sim::load_scenario(std::string(JAYWALK_RIG) + "/drive/hall.toml"), 3, clock,
                              folder, in_thread);
    clock.live = [&robot] { robot.step_far_end(); };
    robot.laser().start();
    const Time limit = clock.now() + 60s;
    while (robot.laser().latest().sequence == 0 && clock.now() < limit) clock.sleep_until(clock.now() + 1ms);
    static_cast<void>(robot.drive().arm());
    // From here on the loop's thread alone sleeps by the clock.
    SteadyClock mine;
    RobotLoop& loop = robot.loop();
    loop.start({.priority = 0});
    std::uint64_t ticks = 0;
    bool asked = false;
    while (!loop.has_ended() && mine.now() < limit) {
      mine.sleep_until(mine.now() + 5ms);
      robot.runner().drain();
      for (; loop.traces().front() != nullptr; loop.traces().pop()) ticks = loop.traces().front()->status.ticks;
      if (ticks > 5 && !asked) asked = robot.desk().obey("goto 9 8") == "going\n";
      if (ticks > 100) loop.end();
    }
    REQUIRE(loop.has_ended());
    CHECK(asked);
    CHECK(ticks > 100);
    CHECK_FALSE(robot.drive().is_enabled());
    CHECK(robot.far_end().rim_speed() == 0.0);
    CHECK(robot.far_end().drive(0).state_name() != "enabled");
  }
  std::filesystem::remove_all(folder);
}
