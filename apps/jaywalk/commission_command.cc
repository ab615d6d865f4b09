#include "apps/jaywalk/commission_command.h"

#include <algorithm>
#include <cstdio>

#include "apps/setup/armed_session.h"
#include "apps/setup/wiring_checks.h"
#include "firmware/robot/commissioned.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

/// The wheels are turned for each scanner anew, and judged by what it sees.
std::vector<CheckedPart> seen_by(std::size_t scanner, ArmedSession& session) {
  RobotModel model = session.file().setup.model;
  const std::string name = scanner_name(model, scanner);
  model.laser = model.lasers()[scanner];
  const NudgeSetup setup{.model = model, .tick = session.file().setup.tick()};
  const std::vector<Nudge> nudges = nudge_wheels(setup, session.devices().drive(), *session.devices().lasers()[scanner],
                                                 session.clock(), ArmedSession::stopped);
  std::vector<CheckedPart> checks = judge_nudges(nudges, model);
  for (CheckedPart& check : checks) check.part = name.empty() ? check.part : name + " scanner: " + check.part;
  return checks;
}

int commission_robot(const SessionOptions& options) {
  ArmedSession session(options, "commission",
                       "The wheels will turn, each by 12 cm, forward and back. Is half a metre free all round?");
  const RobotFile& file = session.file();
  withdraw_commissioned(options.robot, file);
  std::vector<CheckedPart> checks;
  try {
    for (std::size_t k = 0; k < file.lasers().size(); ++k) {
      for (CheckedPart& check : seen_by(k, session)) checks.push_back(std::move(check));
    }
  } catch (const StartupError&) {
    session.disarm();
    throw;
  }
  session.disarm();
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
