#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace jaywalk {

[[nodiscard]] inline std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// What bash, zsh or fish offer to complete: commands, options, and the words of options that take one of a few. Made
/// from what --help prints from. Throws StartupError for another shell.
[[nodiscard]] std::string completion_for(const CLI::App& app, const std::string& shell);

}  // namespace jaywalk
