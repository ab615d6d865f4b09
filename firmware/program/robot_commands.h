#pragma once
#include <CLI/CLI.hpp>

#include "firmware/program/run_command.h"

namespace jaywalk {

/// Adds run, check, goto, stop, reset and status to the command line. The chosen one runs within parse() and leaves
/// its exit code in `exit_code`; all outlive the parsing.
void add_robot_commands(CLI::App& app, int& exit_code, const MakeObserver& make_observer);

}  // namespace jaywalk
