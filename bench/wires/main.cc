// How long it takes from a tick's start to its last frame, and from a scan's last byte to the first frame whose verdict
// used it: the whole controller in real time, CAN in this process, the scanner on a real socket.
// docs/explanation/results.md#time.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "apps/report/distribution.h"
#include "bench/command_line.h"
#include "firmware/backends.h"
#include "hil/far_end/simulated_robot.h"

namespace jaywalk::bench {
namespace {
struct Options {
  std::filesystem::path scenario = "tools/rig/drive/hall.toml", robot = "tools/rig/drive/robot.toml";
  std::filesystem::path out = "out/wire_time";
  double seconds = 60.0;
};

struct Figures {
  Distribution waking_ms, tick_to_frame_ms, scan_to_frame_ms;
};

/// Keeps it driving to and fro between the scenario's goal and its start. `goal`: the newest; none at first.
void keep_going(const sim::Scenario& scenario, rig::InProcessRobot& robot, std::optional<Vec2>& goal) {
  if (goal && distance(robot.far_end().truth().map_from_robot.position(), *goal) > 0.5) return;
  goal = goal == scenario.goal ? scenario.start.position() : scenario.goal;
  const std::string line = "goto " + std::to_string(goal->x) + " " + std::to_string(goal->y);
  static_cast<void>(robot.desk().obey(line));
}

Figures measure(const Options& options) {
  const sim::Scenario scenario = sim::load_scenario(options.scenario);
  const RobotFile file = load_robot_file(options.robot);
  rig::RealLivingClock clock;
  rig::InProcessRobot robot(file, scenario, 3, clock, {options.out, [](const ControlSetup& setup) {
                                                         static TickObserver nobody;
                                                         ChosenPlanner chosen = make_planner(setup);
                                                         chosen.planner = std::make_unique<PlannerThread>(
                                                             std::move(chosen.planner), map_for(setup), nobody);
                                                         return chosen;
                                                       }});
  clock.live = [&robot] { robot.step_far_end(); };
  for (const std::string& line : lock_memory()) std::fprintf(stderr, "%s\n", line.c_str());
  robot.laser().start(laser_priority(file.realtime));
  while (robot.laser().latest().sequence == 0) clock.sleep_until(clock.now() + rig::kLivingStep);
  static_cast<void>(robot.drive().arm());
  for (const std::string& line : enter_realtime(file.realtime)) std::fprintf(stderr, "%s\n", line.c_str());

  Figures figures;
  std::optional<Vec2> goal;
  const Time end = clock.now() + duration_from_seconds(options.seconds);
  std::uint32_t used = robot.laser().latest().sequence;
  for (Time due = clock.now() + file.setup.tick(); due < end; due += file.setup.tick()) {
    clock.sleep_until(due);
    const Time began = clock.now();
    robot.loop().tick(due);
    const auto ms_since = [sent = robot.bus().sent()](Time t) { return 1e3 * to_seconds(sent - t); };
    figures.waking_ms.add(1e3 * to_seconds(began - due));
    figures.tick_to_frame_ms.add(ms_since(began));
    for (; used < robot.runner().last().scan.sequence; ++used)
      figures.scan_to_frame_ms.add(ms_since(robot.messages()[used]));
    robot.runner().drain();
    while (robot.loop().traces().front() != nullptr) robot.loop().traces().pop();
    keep_going(scenario, robot, goal);
  }
  return figures;
}

}  // namespace
}  // namespace jaywalk::bench

int main(int argc, char** argv) {
  using namespace jaywalk::bench;
  Options options;
  CLI::App app("Times ticks and scans on their way to the wheels, in real time", "jaywalk_wire_time");
  app.add_option("--scenario", options.scenario, "The far end's world")->capture_default_str();
  app.add_option("--robot", options.robot, "The controller's side (docs/tutorial/first-real-robot.md)")
      ->capture_default_str();
  app.add_option("--seconds", options.seconds, "How long")->check(CLI::Range(1.0, 3600.0))->capture_default_str();
  app.add_option("--out", options.out, "Folder for what the run leaves")->capture_default_str();
  return run(app, argc, argv, [&] {
    const Figures figures = measure(options);
    print_head("ms");
    print_row("from when a tick was due to its start", figures.waking_ms);
    print_row("from a tick's start to its last frame", figures.tick_to_frame_ms);
    print_row("from a scan's last byte to the first frame that used it", figures.scan_to_frame_ms);
  });
}
