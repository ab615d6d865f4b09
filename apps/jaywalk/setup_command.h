#pragma once
#include <CLI/CLI.hpp>

namespace jaywalk {

/// `jaywalk setup`: writes a ROBOT.toml from what is found and what a person knows, then looks at it as `check` does.
void add_setup(CLI::App& app, int& exit_code);

}  // namespace jaywalk
