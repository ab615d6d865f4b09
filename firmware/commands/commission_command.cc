#include "firmware/commands/commission_command.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <iostream>
#include <string>

#include "firmware/robot/control_socket.h"
#include "firmware/robot/realtime.h"
#include "firmware/robot/robot_devices.h"
#include "firmware/robot/steady_clock.h"
#include "firmware/setup/commissioned.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

std::atomic<bool> stopped{false};

void require_consent(bool yes) {
  if (yes) return;
  if (::isatty(STDIN_FILENO) == 0)
    throw StartupError("commission: the wheels will turn, and nobody is there to be asked",
                       "give --yes where the robot has half a metre of room all round");
  std::fputs("The wheels will turn, each by 12 cm, forward and back. Is half a metre free all round? [yes/no] ",
             stderr);
  std::string answer;
  std::getline(std::cin, answer);
  if (answer != "yes") throw StartupError("commission: not confirmed", "answer yes, or give --yes");
}

std::string obey(std::string_view line) {
  if (line != "stop" && line != "stop now") return "refused: commissioning is under way; it knows stop\n";
  stopped = true;
  return "stopping\n";
}

/// What the kernel does not permit of what this thread and its process wish.
std::vector<std::string> enter_fully(const RealtimeWishes& wishes) {
  std::vector<std::string> refused;
  if (wishes.lock_memory) refused = lock_memory();
  for (std::string& line : enter_realtime(wishes)) refused.push_back(std::move(line));
  return refused;
}

/// At rest already.
void disarm(WiredDrive& drive, Clock& clock) {
  const Time limit = clock.now() + std::chrono::milliseconds(500);
  do {
    static_cast<void>(drive.latest());
    drive.disarm();
    clock.sleep_until(clock.now() + std::chrono::milliseconds(10));
  } while (drive.is_enabled() && clock.now() < limit);
}

}  // namespace

int commission_robot(const CommissionOptions& options) {
  RobotFile file = load_robot_file(options.robot);
  if (options.allow_no_realtime) file.realtime.required = false;
  require_consent(options.yes);
  const std::filesystem::path of_file = file.control_socket.empty() ? default_control_socket() : file.control_socket;
  const ControlSocket socket(options.control_socket.empty() ? of_file : options.control_socket, obey);
  ::signal(SIGINT, [](int) { stopped = true; });
  ::signal(SIGTERM, [](int) { stopped = true; });
  SteadyClock clock;
  RobotDevices devices(file, clock);
  devices.start();
  require_realtime(file.realtime, enter_fully(file.realtime));  // before the drives may turn a wheel
  static_cast<void>(devices.drive().arm());
  withdraw_commissioned(options.robot, file);
  const NudgeSetup setup{.model = file.setup.model, .tick = file.setup.tick()};
  std::vector<Nudge> nudges;
  try {
    nudges = nudge_wheels(setup, devices.drive(), devices.laser(), clock, [] { return stopped.load(); });
  } catch (const StartupError&) {
    disarm(devices.drive(), clock);
    throw;
  }
  disarm(devices.drive(), clock);
  const std::vector<WiringCheck> checks = judge_nudges(nudges, file.setup.model);
  for (const WiringCheck& check : checks)
    std::printf("%-4s  %-15s %s\n", check.is_well ? "ok" : "FAIL", check.part.c_str(), check.said.c_str());
  write_commissioned(options.robot, file, checks);
  return std::all_of(checks.begin(), checks.end(), [](const WiringCheck& check) { return check.is_well; }) ? 0 : 1;
}

}  // namespace jaywalk
