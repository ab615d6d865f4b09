#pragma once
#include <CLI/CLI.hpp>

namespace jaywalk {

/// `jaywalk commission ROBOT.toml`: turns each wheel a little and checks motors, encoders, sides, counts and the
/// scanner against what the scans show; prints a line a check and leaves ROBOT.commissioned.json. Returns 0 where all
/// is well, else 1. Throws StartupError where it may not begin: nothing is written then; or had to be broken off: then
/// what was found before is withdrawn.
void add_commission(CLI::App& app, int& exit_code);

}  // namespace jaywalk
