#pragma once
#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <vector>

#include "hal/shown_text.h"
#include "hal/types/errors.h"

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

/// Throws StartupError for a word of the command line that is empty, or an option that ends in "=": the parser would
/// read a number as 0, from a shell's unset variable, say.
inline void refuse_empty_words(int argc, const char* const* argv) {
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    const bool option_of_nothing = word.rfind("--", 0) == 0 && word.back() == '=';
    if (!word.empty() && !option_of_nothing) continue;
    const std::string place = option_of_nothing ? " behind " + shown(word)
                              : k > 1           ? " behind " + shown(argv[k - 1])
                                                : "";
    throw StartupError("a word of the command line is empty" + place, "give a value, or leave it out");
  }
}

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
