#pragma once
// The whole controller with both ends of its wires in this process, time moved on by hand.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "hil/far_end/simulated_robot.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

namespace jaywalk::tests {

using namespace std::chrono_literals;

[[nodiscard]] inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A robot of tools/rig/drive with the simulated robot at its far end; armed.
struct WiredBench {
  explicit WiredBench(const std::string& robot_name, const std::optional<PanelWiring>& panel = {}, int rate_hz = 50,
                      StickUse steering = StickUse::kNone)
      : WiredBench(robot_name, quiet, panel, rate_hz, steering) {}
  /// `observer` outlives it.
  WiredBench(const std::string& robot_name, TickObserver& observer, const std::optional<PanelWiring>& panel = {},
             int rate_hz = 50, StickUse steering = StickUse::kNone)
      : folder(std::filesystem::temp_directory_path() /
               ("jaywalk_wired_tick_" + robot_name + std::to_string(::getpid()))),
        period(duration_from_seconds(1.0 / rate_hz)),
        robot(file(robot_name, panel, rate_hz, steering),
              sim::load_scenario(std::string(JAYWALK_RIG) + "/drive/hall.toml"), 3, clock, {folder, {}, &observer}) {
    clock.live = [this] {
      robot.step_far_end();
      const AllocationGuard guard;
      robot.laser().step();
      heap_calls += guard.calls();
    };
    while (robot.laser().latest().sequence == 0 && clock.now() < Time{5s}) clock.sleep_until(clock.now() + 1ms);
    static_cast<void>(robot.drive().arm());
    due = clock.now();
  }
  ~WiredBench() { std::filesystem::remove_all(folder); }
  [[nodiscard]] RobotFile file(const std::string& name, const std::optional<PanelWiring>& panel, int rate_hz,
                               StickUse steering) const {
    std::filesystem::create_directories(folder);
    const std::filesystem::path mine = folder / "robot.toml";
    std::ofstream(mine) << "rate_hz = " << rate_hz << ".0\n"
                        << text_of(std::string(JAYWALK_RIG) + "/drive/" + name + ".toml");
    RobotFile wiring = load_robot_file(mine);
    wiring.setup.backend = Backend::kCpu;
    wiring.panel = panel;
    wiring.setup.steering = steering;
    if (wiring.laser.host.empty()) wiring.laser.device = folder / "scanner";
    return wiring;
  }
  void sleep() {
    due += period;
    clock.sleep_until(due);
  }
  void tick() {
    sleep();
    const AllocationGuard guard;
    robot.loop().tick(due);
    heap_calls += guard.calls();
    drain();
  }
  void drain() {
    robot.runner().drain();
    while (robot.loop().traces().front() != nullptr) robot.loop().traces().pop();
  }
  void tick(int times) {
    for (int k = 0; k < times; ++k) tick();
  }
  [[nodiscard]] double speed_mps() { return robot.far_end().rim_speed(); }
  [[nodiscard]] const TickRecord& last() { return robot.runner().last(); }

  std::filesystem::path folder;
  Duration period;
  rig::HandLivingClock clock;
  std::uint64_t heap_calls = 0;
  TickObserver quiet;
  rig::InProcessRobot robot;
  Time due{};
};

/// A line whose answer takes ticks, as `here` does.
[[nodiscard]] inline std::string say(WiredBench& bench, const std::string& line) {
  const ControlReply reply = bench.robot.desk().reply_to(line);
  if (!reply.job) return reply.text;
  bench.tick(400);
  return reply.job();
}

}  // namespace jaywalk::tests
