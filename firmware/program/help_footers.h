#pragma once
#include <CLI/CLI.hpp>

namespace jaywalk {

/// Under each command's help: an example, and what its exit code says.
void add_footers(CLI::App& app);

}  // namespace jaywalk
