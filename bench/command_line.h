#pragma once
// Command line of the programs that measure, and the table that they print.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>

#include "apps/report/distribution.h"
#include "firmware/program/program.h"

namespace jaywalk::bench {
/// Reads the command line, and works where the program is not to end at once. Where the command line or what it names
/// is of no use says so in a line. Returns the exit code: 2 then, else 0.
inline int run(CLI::App& app, int argc, char** argv, const std::function<void()>& work) {
  app.failure_message([](const CLI::App* of, const CLI::Error& error) {
    return of->get_name() + ": " + error.what() + "; see " + of->get_name() + " --help\n";
  });
  try {
    refuse_empty_words(argc, argv);
    app.parse(argc, argv);
    work();
    return 0;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const StartupError& error) {
    std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), error.what());
    return 2;
  }
}

/// Prints the head of a table of distributions: median, 99th percentile, largest value.
inline void print_head(const char* what) {
  std::printf("| %-56s | %8s | %8s | %8s |\n|---|---|---|---|\n", what, "p50", "p99", "max");
}

/// Prints its row of one distribution, in the unit that `what` names.
inline void print_row(const char* what, const Distribution& figure) {
  std::printf("| %-56s | %8.3f | %8.3f | %8.3f |\n", what, figure.quantile(0.5), figure.quantile(0.99), figure.max());
}

}  // namespace jaywalk::bench
