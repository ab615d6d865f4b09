#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace jaywalk {

/// --man, --markdown and --completion: printed from what --help prints from, so that they cannot differ.
void add_manual_options(CLI::App& app);

/// The manual page of the program and all its commands, for man(1).
[[nodiscard]] std::string man_page(const CLI::App& app);

/// The reference page of the command line. An option that several commands have stands in it once.
[[nodiscard]] std::string markdown_page(const CLI::App& app);

}  // namespace jaywalk
