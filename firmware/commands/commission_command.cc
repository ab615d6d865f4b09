#include "firmware/commands/commission_command.h"

#include <algorithm>
#include <cstdio>

#include "firmware/setup/commissioned.h"
#include "hal/types/errors.h"

namespace jaywalk {

int commission_robot(const SessionOptions& options) {
  ArmedSession session(options, "commission",
                       "The wheels will turn, each by 12 cm, forward and back. Is half a metre free all round?");
  const RobotFile& file = session.file();
  withdraw_commissioned(options.robot, file);
  const NudgeSetup setup{.model = file.setup.model, .tick = file.setup.tick()};
  std::vector<Nudge> nudges;
  try {
    nudges = nudge_wheels(setup, session.devices().drive(), session.devices().laser(), session.clock(),
                          ArmedSession::stopped);
  } catch (const StartupError&) {
    session.disarm();
    throw;
  }
  session.disarm();
  const std::vector<WiringCheck> checks = judge_nudges(nudges, file.setup.model);
  for (const WiringCheck& check : checks)
    std::printf("%-4s  %-15s %s\n", check.is_well ? "ok" : "FAIL", check.part.c_str(), check.said.c_str());
  write_commissioned(options.robot, file, checks);
  return std::all_of(checks.begin(), checks.end(), [](const WiringCheck& check) { return check.is_well; }) ? 0 : 1;
}

}  // namespace jaywalk
