#pragma once
#include <string>

#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {

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

}  // namespace jaywalk
