#include "apps/jaywalk/man_page.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <string_view>
#include <vector>

#include "apps/jaywalk/completion.h"

namespace jaywalk {
namespace {

/// roff takes a backslash, a hyphen, and a line's first point or quotation mark for its own.
std::string roff(const std::string& text) {
  std::string out;
  bool begins = true;
  for (const char c : text) {
    if (begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
    begins = c == '\n';
  }
  return out;
}

/// "--mode full|paper", "--help, -h", "scenario".
std::string option_name(const CLI::Option& option) {
  std::string names;
  for (const std::string& name : option.get_lnames()) names += (names.empty() ? "--" : ", --") + name;
  for (const std::string& name : option.get_snames()) names += (names.empty() ? "-" : ", -") + name;
  if (names.empty()) return option.get_name(true);
  return option.get_type_name().empty() ? names : names + " " + option.get_type_name();
}

std::string entry_of(const CLI::Option& option) {
  const std::string usual = option.get_default_str();
  return ".TP\n.B " + roff(option_name(option)) + "\n" + roff(option.get_description()) +
         (usual.empty() ? "" : " (default: " + roff(usual) + ")") + "\n";
}

std::string section_of(const CLI::App& command) {
  std::string text = ".SS jaywalk " + roff(command.get_name()) + "\n" + roff(command.get_description()) + ".\n";
  for (const CLI::Option* option : command.get_options()) text += entry_of(*option);
  return text + ".PP\n.nf\n" + roff(command.get_footer()) + "\n.fi\n";
}

/// "--out", "--mode full|paper", "--seed N", "scenario": words that the parser thinks of say nothing.
std::string short_name_of(const CLI::Option& option) {
  if (option.get_lnames().empty()) return option.get_name(true);
  std::string type = option.get_type_name();
  if (type.find(":{") != std::string::npos) type = type.substr(type.find('{'));
  const bool is_parsers = type.starts_with("TEXT") || type.starts_with("INT") || type.starts_with("UINT") ||
                          type.starts_with("FLOAT") || type.empty();
  return "--" + option.get_lnames().front() + (is_parsers ? "" : " " + type);
}

std::string item_of(const CLI::Option& option) {
  const std::string usual = option.get_default_str();
  return "- `" + short_name_of(option) + "`: " + option.get_description() + (usual.empty() ? "" : " (" + usual + ")");
}

/// Each option by what the page says of it, with the commands that have it.
std::map<std::string, std::string> commands_by_item(const CLI::App& app) {
  std::map<std::string, std::string> commands;
  for (const CLI::App* command : commands_of(app)) {
    for (const CLI::Option* option : command->get_options()) {
      std::string& names = commands[item_of(*option)];
      names += (names.empty() ? "" : ", ") + command->get_name();
    }
  }
  return commands;
}

bool is_shared(const std::string& commands) { return commands.find(',') != std::string::npos; }

[[noreturn]] void print(const std::string& text) {
  std::fputs(text.c_str(), stdout);
  throw CLI::Success();
}

}  // namespace

std::string man_page(const CLI::App& app) {
  std::string text =
      ".TH JAYWALK 1 \"\" \"jaywalk " + std::string(JAYWALK_VERSION) +
      "\" \"User Commands\"\n.SH NAME\njaywalk \\- drives mobile robots and power wheelchairs among people\n"
      ".SH SYNOPSIS\n.B jaywalk\n.I COMMAND\n[OPTIONS]\n.SH DESCRIPTION\n" +
      roff(app.get_description()) + "\n.SH OPTIONS\n";
  for (const CLI::Option* option : app.get_options()) text += entry_of(*option);
  text += ".PP\n.nf\n" + roff(app.get_footer()) + "\n.fi\n.SH COMMANDS\n";
  for (const CLI::App* command : commands_of(app)) text += section_of(*command);
  return text;
}

std::string markdown_page(const CLI::App& app) {
  const std::map<std::string, std::string> commands = commands_by_item(app);
  std::string page = R"(# Command line

Generated: `jaywalk --markdown >docs/reference/command-line.md`; a test compares the two. Brackets hold defaults. Exit code 2 is
bad input or set-up. `jaywalk COMMAND --help` has an example too; `jaywalk --man` is the manual page.

## Options of several commands

)";
  for (const auto& [item, names] : commands)
    if (is_shared(names) && !item.starts_with("- `--help")) page += item + ". *" + names + "*\n";
  for (const CLI::App* command : commands_of(app)) {
    const std::string footer = command->get_footer();
    constexpr std::string_view kCodes = "Exit code: ";
    const std::size_t codes = footer.find(kCodes) + kCodes.size(), end = footer.find(", 2: bad input");
    page += "\n## " + command->get_name() + "\n\n" + command->get_description() + " (exit code " +
            footer.substr(codes, end - codes) + ").\n";
    std::string items;
    for (const CLI::Option* option : command->get_options())
      if (!is_shared(commands.at(item_of(*option)))) items += item_of(*option) + "\n";
    if (!items.empty()) page += "\n" + items;
  }
  return page;
}

void add_manual_options(CLI::App& app) {
  app.add_flag_callback(
      "--man", [&app] { print(man_page(app)); }, "Print the manual page: jaywalk --man | man -l -");
  app.add_flag_callback(
      "--markdown", [&app] { print(markdown_page(app)); }, "Print the page docs/reference/command-line.md");
  app.add_option_function<std::string>(
         "--completion", [&app](const std::string& shell) { print(completion_for(app, shell)); },
         "Print what a shell needs to complete commands and options")
      ->type_name("bash|zsh|fish");
}

}  // namespace jaywalk
