#pragma once
// Options whose value is one of a few words.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "firmware/backends.h"
#include "firmware/recording/run_parts.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {

template <class T>
struct Choice {
  std::string word;
  T value;
};

/// `chosen` holds the default. Help and errors show the words, which the parser's own checks mix with the values behind
/// them. Parsing throws StartupError for any other word.
template <class T>
void add_choice(CLI::App& command, const std::string& option, T& chosen, const std::vector<Choice<T>>& choices,
                const std::string& about) {
  std::string words, usual;
  for (const Choice<T>& choice : choices) {
    words += (words.empty() ? "" : "|") + choice.word;
    if (choice.value == chosen) usual = choice.word;
  }
  const auto choose = [&chosen, option, choices, words](const std::string& word) {
    const auto found = std::find_if(choices.begin(), choices.end(), [&](const auto& c) { return c.word == word; });
    if (found == choices.end()) throw StartupError(option + ": no such choice: " + shown(word), "give " + words);
    chosen = found->value;
  };
  command.add_option_function<std::string>(option, choose, about)->type_name(words)->default_str(usual);
}

inline void add_backend(CLI::App& command, Backend& chosen, int& device) {
  add_choice<Backend>(command, "--backend", chosen,
                      {{"auto", Backend::kAuto}, {"cpu", Backend::kCpu}, {"cuda", Backend::kCuda}}, "Who plans");
  command.add_option("--device", device, "Number of the GPU that plans, as CUDA counts them from 0")
      ->check(CLI::Range(0, 255))
      ->capture_default_str();
}

/// --part-bytes and --keep-parts.
inline void add_parts(CLI::App& command, PartsKept& kept) {
  command
      .add_option("--part-bytes", kept.bytes,
                  "Recording and tables in parts of at most so many bytes, 200000 or more; 0: whole")
      ->type_name("UINT")
      ->capture_default_str();
  command.add_option("--keep-parts", kept.parts, "How many parts are kept, the one that is written among them")
      ->check(CLI::Range(2, 1'000'000))
      ->capture_default_str();
}

}  // namespace jaywalk
