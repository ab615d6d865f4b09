#pragma once
#include <CLI/CLI.hpp>

namespace jaywalk {

/// Adds `jaywalk config`: what may stand in the settings files, from the tables that their parsers use.
void add_config(CLI::App& app, int& exit_code);

}  // namespace jaywalk
