#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "hal/nearest_word.h"
#include "hal/shown_text.h"

namespace jaywalk {

/// The first option that `command` does not have, with the one that was meant; empty where all are known.
inline std::string unknown_option(const std::string& program, const CLI::App& command) {
  std::vector<std::string> known;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  for (const std::string& word : command.remaining()) {
    if (word.rfind('-', 0) != 0) continue;
    const std::string see = "see " + program + " " + command.get_name() + " --help";
    return shown(word) + ": no such option; " + did_you_mean(word.substr(0, word.find('=')), known, see);
  }
  return "";
}

/// One line for a command line that the parser refuses.
inline std::string parse_message(const CLI::App* app, const CLI::Error& error) {
  const auto given = app->get_subcommands();
  const std::string unknown = given.empty() ? "" : unknown_option(app->get_name(), *given[0]);
  if (!unknown.empty()) return app->get_name() + ": " + unknown + "\n";
  return app->get_name() + ": " + printable(error.what()) + "; see " + app->get_name() + " " +
         (given.empty() ? "" : given[0]->get_name() + " ") + "--help\n";
}

}  // namespace jaywalk
