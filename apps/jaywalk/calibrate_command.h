#pragma once
#include <CLI/CLI.hpp>

namespace jaywalk {

/// `jaywalk calibrate ROBOT.toml|RUN`: from a guided drive or a recording, the keys that put wheels and mount right.
void add_calibrate(CLI::App& app, int& exit_code);

}  // namespace jaywalk
