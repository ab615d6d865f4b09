#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace jaywalk {

/// --man, --markdown and --completion: printed from what --help prints from, so that they cannot differ.
void add_manual_options(CLI::App& app);

/// The manual page of the program and all its commands, for man(1).
[[nodiscard]] std::string man_page(const CLI::App& app);

/// The reference page of the command line. An option that several commands have stands in it once.
[[nodiscard]] std::string markdown_page(const CLI::App& app);

[[nodiscard]] inline std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// What bash, zsh or fish offer to complete: commands, options, and the words of options that take one of a few. Made
/// from what --help prints from. Throws StartupError for another shell.
[[nodiscard]] std::string completion_for(const CLI::App& app, const std::string& shell);

}  // namespace jaywalk
