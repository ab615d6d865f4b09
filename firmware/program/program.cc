#include "firmware/program/program.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "firmware/backends.h"
#include "firmware/program/parse_message.h"
#include "firmware/program/standard_streams.h"
#include "hal/setting_keys.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr int kBadInput = 2;

/// The parser would only say that one is missing.
void require_command(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (argc > 1 && (argv[1][0] == '-' || command->get_name() == argv[1])) return;
    names.push_back(command->get_name());
  }
  const std::string all = "there are " + joined(names);
  if (argc <= 1) throw StartupError("a subcommand is required", all);
  throw StartupError(shown(argv[1]) + ": no such subcommand", did_you_mean(argv[1], names, all));
}

int parse_and_run(CLI::App& app, int argc, char** argv, const AddCommands& add_commands) {
  int exit_code = 0;
  app.set_version_flag("--version", app.get_name() + " " + JAYWALK_VERSION + ", backends: " + built_backends());
  app.require_subcommand(1);
  app.failure_message(parse_message);
  add_commands(app, exit_code);
  refuse_empty_words(argc, argv);
  require_command(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadInput;
  }
  return exit_code;
}

}  // namespace

int run_program(CLI::App& app, int argc, char** argv, const AddCommands& add_commands) {
  open_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow (ulimit -f) is a full disk, and told as one
  int code = kBadInput;
  try {
    code = parse_and_run(app, argc, argv, add_commands);
    require_heard();
  } catch (const StartupError& error) {
    std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), printable(error.what()).c_str());
    code = kBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s; please report this with the command that led to it\n", app.get_name().c_str(),
                 printable(error.what()).c_str());
    code = kBadInput;
  }
  if (has_device_left_behind()) std::fflush(nullptr), std::_Exit(code);
  return code;
}

}  // namespace jaywalk
