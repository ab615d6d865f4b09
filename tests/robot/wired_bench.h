#pragma once
// The whole controller with both ends of its wires in this process, time moved on by hand.
#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include "hal/shown_text.h"
#include "hal/text_file.h"
#include "hil/far_end/simulated_robot.h"
#include "tests/recording/scratch.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

namespace jaywalk::tests {

using namespace std::chrono_literals;

[[nodiscard]] inline std::string rig_file(const std::string& name) {
  return std::string(JAYWALK_RIG) + "/drive/" + name + ".toml";
}

/// The world of the rig; nobody else is in it.
[[nodiscard]] inline sim::Scenario empty_hall() {
  sim::Scenario scenario = sim::load_scenario(rig_file("hall"));
  scenario.wanderers.clear();
  return scenario;
}

/// A robot file that plans on the CPU; a scanner of a serial line is found in `folder`.
[[nodiscard]] inline RobotFile robot_in(const std::filesystem::path& folder, const std::filesystem::path& path) {
  RobotFile file = load_robot_file(path);
  file.setup.backend = Backend::kCpu;
  if (file.laser.host.empty()) file.laser.device = folder / "scanner";
  return file;
}

/// A robot whose wires live, and whose scanners have scanned; its drives are not armed.
struct LiveBench {
  using MakeFile = std::function<RobotFile(const Scratch&)>;
  using MakeWorld = std::function<sim::Scenario(const RobotFile&)>;

  LiveBench(const MakeFile& make_file, const MakeWorld& make_world, std::uint64_t seed = 3,
            TickObserver* observer = nullptr, bool real_line = false)
      : file(make_file(scratch)),
        robot(file, make_world(file), seed, clock, {scratch.folder(), {}, observer, real_line}) {
    clock.live = [this] {
      robot.step_far_end();
      const AllocationGuard guard;
      for (const auto& laser : robot.lasers()) laser->step();
      heap_calls += guard.calls();
    };
    for (const auto& laser : robot.lasers()) {
      while (laser->latest().sequence == 0 && clock.now() < Time{5s}) clock.sleep_until(clock.now() + 1ms);
    }
    due = clock.now();
  }
  [[nodiscard]] std::vector<std::string> arm() {
    std::vector<std::string> report = robot.drive().arm();
    due = clock.now();
    return report;
  }
  void sleep() { clock.sleep_until(due += file.setup.tick()); }
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
  /// Ticks until `holds`, `most` at most; whether it does.
  template <class Holds>
  bool tick_until(int most, Holds holds) {
    for (int k = 0; k < most && !holds(); ++k) tick();
    return holds();
  }
  std::string obey(const std::string& line) { return robot.desk().obey(line); }
  /// Drives towards a goal for so many ticks.
  void go(int ticks, const std::string& goal = "goto 9 8") {
    REQUIRE(obey(goal) == "going\n");
    tick(ticks);
  }
  [[nodiscard]] std::string status() { return obey("status"); }
  [[nodiscard]] rig::SimulatedRobot& far_end() { return robot.far_end(); }
  [[nodiscard]] double speed_mps() { return far_end().rim_speed(); }
  double speed_after(int ticks) {
    tick(ticks);
    return speed_mps();
  }
  [[nodiscard]] const TickRecord& last() { return robot.runner().last(); }
  [[nodiscard]] bool shows(Reason reason) { return has(last().verdict.reasons, reason); }
  [[nodiscard]] bool is_latched() { return shows(Reason::kLatched); }
  [[nodiscard]] bool is_doubtful() { return shows(Reason::kPoseDoubtful); }
  [[nodiscard]] const Pose2& truth() { return far_end().truth().map_from_robot; }
  /// The believed pose less the true one.
  [[nodiscard]] double off_m() { return distance(last().pose.map_from_robot.position(), truth().position()); }
  [[nodiscard]] double off_rad() { return std::fabs(wrap_angle(last().pose.map_from_robot.heading - truth().heading)); }
  /// A person resets, and waits until the drives are proved.
  void reset() {
    CHECK(obey("reset") == "reset\n");
    tick_until(300, [&] { return !is_latched(); });
  }

  Scratch scratch;
  rig::HandLivingClock clock;
  std::uint64_t heap_calls = 0;
  RobotFile file;
  rig::InProcessRobot robot;
  Time due{};
};

/// A robot of tools/rig/drive in the rig's world; armed. `observer` outlives it.
struct WiredBench : LiveBench {
  explicit WiredBench(const std::string& robot_name, const std::optional<panel::JoystickSetup>& panel = {},
                      int rate_hz = 50, StickUse steering = StickUse::kNone, TickObserver* observer = nullptr)
      : LiveBench(
            [&](const Scratch& folder) {
              const std::string text = "rate_hz = " + std::to_string(rate_hz) + ".0\n" + text_in(rig_file(robot_name));
              RobotFile wiring = robot_in(folder.folder(), folder.write("robot.toml", text));
              wiring.panel = panel;
              wiring.setup.steering = steering;
              return wiring;
            },
            [](const RobotFile&) { return sim::load_scenario(rig_file("hall")); }, 3, observer) {
    static_cast<void>(arm());
  }
};

[[nodiscard]] inline std::string here(const Pose2& place) {
  return formatted("here %.3f %.3f %.3f", place.x, place.y, wrap_angle(place.heading));
}

/// A line whose answer takes ticks, as `here` does.
[[nodiscard]] inline std::string say(LiveBench& bench, const std::string& line) {
  const ControlReply reply = bench.robot.desk().reply_to(line);
  if (!reply.job) return reply.text;
  bench.tick(400);
  return reply.job();
}

}  // namespace jaywalk::tests
