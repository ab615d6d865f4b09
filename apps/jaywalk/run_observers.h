#pragma once
#include <CLI/CLI.hpp>

#include "firmware/program/run_command.h"

namespace jaywalk {

/// Adds the live page's options to `jaywalk run`, which add_robot_commands() has added.
void add_run_view(CLI::App& app);

/// A MakeObserver: tables and pictures, and the live page where it was asked for.
[[nodiscard]] std::unique_ptr<TickObserver> observe_run(const RunOptions& options, const RobotFile& file,
                                                        const std::filesystem::path& control_socket);

}  // namespace jaywalk
