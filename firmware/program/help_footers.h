#pragma once
#include <CLI/CLI.hpp>
#include <span>

namespace jaywalk {

/// What stands under a command's help.
struct Footer {
  const char* command;
  const char* example;  ///< without the program's name
  const char* zero;     ///< meaning of exit code 0
  const char* one;      ///< of exit code 1; "-": there is none
};

/// Under each command's help: an example, and what its exit code says. The program's own help shows the first.
void add_footers(CLI::App& app, std::span<const Footer> footers);

}  // namespace jaywalk
