#pragma once
#include <CLI/CLI.hpp>
#include <functional>

namespace jaywalk {

/// Adds its commands to the command line. The chosen one runs within parse() and leaves its exit code.
using AddCommands = std::function<void(CLI::App& app, int& exit_code)>;

/// The whole of main() for a program of commands: parses, runs the chosen one, and says in one line what keeps it from
/// running. Returns the process's exit code, 2 for bad input or set-up.
[[nodiscard]] int run_program(CLI::App& app, int argc, char** argv, const AddCommands& add_commands);

}  // namespace jaywalk
