#pragma once
#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>

#include "firmware/program/program.h"

namespace jaywalk::bench {
/// Reads the command line. Where it is of no use says so in a line; where the program is to end, with which exit code:
/// 2 then, 0 after --help.
inline std::optional<int> ended_by_command_line(CLI::App& app, int argc, char** argv) {
  app.failure_message([](const CLI::App* of, const CLI::Error& error) {
    return of->get_name() + ": " + error.what() + "; see " + of->get_name() + " --help\n";
  });
  try {
    refuse_empty_words(argc, argv);
    app.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const StartupError& error) {
    std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), error.what());
    return 2;
  }
}

}  // namespace jaywalk::bench
