#include <algorithm>
#include <cstdio>

#include "apps/jaywalk/commands.h"
#include "apps/setup/armed_session.h"
#include "apps/setup/wiring_checks.h"
#include "firmware/robot/commissioned.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

int commission_robot(const SessionOptions& options) {
  ArmedSession session(options, "commission",
                       "The wheels will turn, each by 12 cm, forward and back. Is half a metre free all round?");
  const RobotFile& file = session.file();
  withdraw_commissioned(options.robot, file);
  const NudgeSetup setup{.model = file.setup.model, .tick = file.setup.tick()};
  std::vector<Nudge> nudges;
  try {
    nudges = nudge_wheels(setup, session.drive(), session.lasers(), session.clock(), ArmedSession::stopped);
  } catch (const StartupError&) {
    session.disarm();
    throw;
  }
  session.disarm();
  const std::vector<CheckedPart> checks = judge_nudges(nudges, setup.model);
  for (const CheckedPart& check : checks)
    std::printf("%-4s  %-15s %s\n", check.is_well ? "ok" : "FAIL", check.part.c_str(), check.said.c_str());
  write_commissioned(options.robot, file, checks);
  return std::all_of(checks.begin(), checks.end(), [](const CheckedPart& check) { return check.is_well; }) ? 0 : 1;
}

}  // namespace

void add_commission(CLI::App& app, int& exit_code) {
  static SessionOptions commission_options;
  CLI::App* commission = app.add_subcommand("commission", "Turn each wheel a little and check how all is wired");
  commission->add_option("robot", commission_options.robot, "Robot file (TOML; docs/tutorial/first-real-robot.md)")
      ->required();
  commission->add_option("--socket", commission_options.control_socket, "Control socket (default: the file's)");
  commission->add_flag("--yes", commission_options.yes, "The wheels may turn: do not ask");
  commission->add_flag("--allow-no-realtime", commission_options.allow_no_realtime,
                       "Go on where the kernel refuses real-time priority or locked memory");
  commission->callback([&exit_code] { exit_code = commission_robot(commission_options); });
}

}  // namespace jaywalk
