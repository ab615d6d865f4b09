#include "apps/jaywalk/completion.h"

#include <algorithm>
#include <vector>

#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

std::string long_names(const CLI::App& app) {
  std::string words;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) words += (words.empty() ? "--" : " --") + name;
  return words;
}

/// The words that an option takes, as "full paper"; empty where it takes any value.
std::string value_words(const CLI::Option& option) {
  std::string words = option.get_type_name();
  if (words.find(":{") != std::string::npos) {  // the parser's own way to say it: "TEXT:{a,b}"
    words = words.substr(words.find('{') + 1, words.rfind('}') - words.find('{') - 1);
    std::replace(words.begin(), words.end(), ',', ' ');
    return words;
  }
  if (words.find('|') == std::string::npos) return "";
  std::replace(words.begin(), words.end(), '|', ' ');
  return words;
}

std::string bash_choices_of(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : command.get_options()) {
    const std::string words = value_words(*option);
    if (words.empty() || option->get_lnames().empty()) continue;
    text += "    '" + command.get_name() + " --" + option->get_lnames().front() + "') words='" + words + "' ;;\n";
  }
  return text;
}

std::string bash_completion(const CLI::App& app) {
  std::string names, options, choices;
  for (const CLI::App* command : commands_of(app)) {
    names += command->get_name() + " ";
    options += "    " + command->get_name() + ") words='" + long_names(*command) + "' ;;\n";
    choices += bash_choices_of(*command);
  }
  return "# bash completion of jaywalk\n_jaywalk() {\n"
         "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command='' words='' k\n"
         "  for ((k = 1; k < COMP_CWORD; ++k)); do\n"
         "    [[ ${COMP_WORDS[k]} == -* ]] || { command=${COMP_WORDS[k]}; break; }\n  done\n"
         "  case $command in\n    '') words='" +
         names + long_names(app) + "' ;;\n" + options +
         "  esac\n  [[ -z $command || $word == -* ]] || words=''  # a file, then\n  case \"$command $before\" in\n" +
         choices +
         "  esac\n  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n}\n"
         "complete -o default -F _jaywalk jaywalk\n";
}

/// Within single quotes of a shell; `more` are characters that the place takes for its own.
std::string quoted(const std::string& text, const std::string& more, const std::string& apostrophe) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += apostrophe;
      continue;
    }
    if (more.find(c) != std::string::npos) out += '\\';
    out += c;
  }
  return out;
}

/// '--mode[full: ...]:mode:(full paper)', an entry of zsh's _arguments.
std::string zsh_options_of(const CLI::App& command, const std::string& indent) {
  std::string text;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      const std::string words = value_words(*option);
      text += indent + "'--" + name + "[" + quoted(option->get_description(), "[]\\:", "'\\''") + "]";
      if (option->get_items_expected_max() > 0)
        text += ":" + name + ":" + (words.empty() ? "_files" : "(" + words + ")");
      text += "' \\\n";
    }
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
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      const std::string words = value_words(*option);
      text += "complete -c jaywalk -n '" + condition + "' -l " + name;
      if (!words.empty())
        text += " -x -a '" + words + "'";
      else if (option->get_items_expected_max() > 0)
        text += " -r";
      text += " -d '" + quoted(option->get_description(), "\\", "\\'") + "'\n";
    }
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

}  // namespace

std::string completion_for(const CLI::App& app, const std::string& shell) {
  if (shell == "bash") return bash_completion(app);
  if (shell == "zsh") return zsh_completion(app);
  if (shell == "fish") return fish_completion(app);
  throw StartupError("--completion: " + shown(shell) + " is not written for", "give bash, zsh or fish");
}

}  // namespace jaywalk
