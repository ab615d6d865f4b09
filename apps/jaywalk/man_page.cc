#include <algorithm>
#include <cstdio>
#include <map>
#include <string_view>

#include "apps/jaywalk/commands.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

/// roff takes a backslash, a hyphen, and a line's first point or quotation mark for its own.
std::string roff(const std::string& text) {
  std::string out;
  bool begins = true;
  for (const char c : text) {
    if (begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\' || c == '-') out += '\\';
    out += c == '\\' ? 'e' : c;
    begins = c == '\n';
  }
  return out;
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
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

/// The words that an option takes, as "full paper"; empty where it takes any value.
std::string value_words(const CLI::Option& option) {
  std::string words = option.get_type_name();
  const bool are_parsers = words.find(":{") != std::string::npos;  // "TEXT:{a,b}"
  if (are_parsers) words = words.substr(words.find('{') + 1, words.rfind('}') - words.find('{') - 1);
  const char between = are_parsers ? ',' : '|';
  if (!are_parsers && words.find(between) == std::string::npos) return "";
  std::ranges::replace(words, between, ' ');
  return words;
}

/// A long name of an option, and what a shell should know of it.
struct LongName {
  std::string name, about;
  std::string words;  ///< that the option takes; empty: any value
  bool takes_value;
};

std::vector<LongName> long_names_of(const CLI::App& command) {
  std::vector<LongName> all;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames())
      all.push_back({name, option->get_description(), value_words(*option), option->get_items_expected_max() > 0});
  return all;
}

std::string listed(const std::vector<LongName>& options) {
  std::string words;
  for (const LongName& option : options) words += (words.empty() ? "--" : " --") + option.name;
  return words;
}

std::string bash_completion(const CLI::App& app) {
  std::string names, options, choices;
  for (const CLI::App* command : commands_of(app)) {
    names += command->get_name() + " ";
    options += "    " + command->get_name() + ") words='" + listed(long_names_of(*command)) + "' ;;\n";
    for (const LongName& option : long_names_of(*command))
      if (!option.words.empty())
        choices += "    '" + command->get_name() + " --" + option.name + "') words='" + option.words + "' ;;\n";
  }
  return "# bash completion of jaywalk\n_jaywalk() {\n"
         "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command='' words='' k\n"
         "  for ((k = 1; k < COMP_CWORD; ++k)); do\n"
         "    [[ ${COMP_WORDS[k]} == -* ]] || { command=${COMP_WORDS[k]}; break; }\n  done\n"
         "  case $command in\n    '') words='" +
         names + listed(long_names_of(app)) + "' ;;\n" + options +
         "  esac\n  [[ -z $command || $word == -* ]] || words=''  # a file, then\n  case \"$command $before\" in\n" +
         choices +
         "  esac\n  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n}\n"
         "complete -o default -F _jaywalk jaywalk\n";
}

/// Within single quotes of a shell; `more` are characters that the place takes for its own.
std::string quoted(const std::string& text, const std::string& more, const std::string& apostrophe) {
  std::string out;
  for (const char c : text) {
    if (more.find(c) != std::string::npos) out += '\\';
    out += c == '\'' ? apostrophe : std::string(1, c);
  }
  return out;
}

/// '--mode[full: ...]:mode:(full paper)', an entry of zsh's _arguments.
std::string zsh_options_of(const CLI::App& command, const std::string& indent) {
  std::string text;
  for (const auto& [name, about, words, takes_value] : long_names_of(command)) {
    text += indent + "'--" + name + "[" + quoted(about, "[]\\:", "'\\''") + "]";
    if (takes_value) text += ":" + name + ":" + (words.empty() ? "_files" : "(" + words + ")");
    text += "' \\\n";
  }
  return text;
}

std::string zsh_completion(const CLI::App& app) {
  std::string names, cases;
  for (const CLI::App* command : commands_of(app)) {
    names += "    '" + command->get_name() + ":" + quoted(command->get_description(), "\\:", "'\\''") + "'\n";
    cases += "    " + command->get_name() + ")\n      _arguments \\\n" + zsh_options_of(*command, "        ") +
             "        '*:file:_files' ;;\n";
  }
  return "#compdef jaywalk\n_jaywalk() {\n  local -a commands\n  commands=(\n" + names +
         "  )\n  if (( CURRENT == 2 )); then\n    _describe command commands\n    _arguments \\\n" +
         zsh_options_of(app, "      ") +
         "      '*::'\n    return\n  fi\n  (( CURRENT-- ))\n  shift words\n  case $words[1] in\n" + cases +
         "  esac\n}\n_jaywalk \"$@\"\n";
}

std::string fish_options_of(const CLI::App& command, const std::string& condition) {
  std::string text;
  for (const auto& [name, about, words, takes_value] : long_names_of(command)) {
    text += "complete -c jaywalk -n '" + condition + "' -l " + name;
    text += words.empty() ? (takes_value ? " -r" : "") : " -x -a '" + words + "'";
    text += " -d '" + quoted(about, "\\", "\\'") + "'\n";
  }
  return text;
}

std::string fish_completion(const CLI::App& app) {
  std::string text = "# fish completion of jaywalk\n" + fish_options_of(app, "__fish_use_subcommand");
  for (const CLI::App* command : commands_of(app)) {
    text += "complete -c jaywalk -f -n __fish_use_subcommand -a " + command->get_name() + " -d '" +
            quoted(command->get_description(), "\\", "\\'") + "'\n" +
            fish_options_of(*command, "__fish_seen_subcommand_from " + command->get_name());
  }
  return text;
}

/// The manual page of the program and all its commands, for man(1).
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

/// The reference page of the command line. An option that several commands have stands in it once.
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

/// Completion script for a shell ("bash", "zsh", ...): commands, options, and the words that an option may take. Throws
/// StartupError for an unknown shell.
std::string completion_for(const CLI::App& app, const std::string& shell) {
  if (shell == "bash") return bash_completion(app);
  if (shell == "zsh") return zsh_completion(app);
  if (shell == "fish") return fish_completion(app);
  throw StartupError("--completion: " + shown(shell) + " is not written for", "give bash, zsh or fish");
}

[[noreturn]] void print(const std::string& text) {
  std::fputs(text.c_str(), stdout);
  throw CLI::Success();
}

}  // namespace

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
