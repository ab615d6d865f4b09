#pragma once
#include <CLI/CLI.hpp>
#include <functional>

#include "firmware/program/run_command.h"

namespace jaywalk {

/// Adds its commands to the command line. The chosen one runs within parse() and leaves its exit code.
using AddCommands = std::function<void(CLI::App& app, int& exit_code)>;

/// The whole of main() for a program of commands: parses, runs the chosen one, and says in one line what keeps it from
/// running. Returns the process's exit code, 2 for bad input or set-up.
[[nodiscard]] int run_program(CLI::App& app, int argc, char** argv, const AddCommands& add_commands);

/// Adds run, check, goto, stop, reset and status to the command line. The chosen one runs within parse() and leaves
/// its exit code in `exit_code`; all outlive the parsing.
void add_robot_commands(CLI::App& app, int& exit_code, const MakeObserver& make_observer);

/// Whatever is opened first takes the number of a standard stream that was closed, a recording or a bus, and is written
/// to by what writes to that: gives such numbers to /dev/null. To be called before anything is opened.
void open_standard_streams();

/// Throws StartupError when standard output did not take all that was said there, as on a full disk.
void require_heard();

}  // namespace jaywalk
