#pragma once
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace jaywalk {

/// How many letters must be inserted, deleted or replaced to make one word of the other (Levenshtein's distance).
[[nodiscard]] inline std::size_t edits_between(std::string_view from, std::string_view to) {
  std::vector<std::size_t> row(to.size() + 1);
  for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
  for (std::size_t i = 0; i < from.size(); ++i) {
    std::size_t above_left = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < to.size(); ++j) {
      const std::size_t replaced = above_left + (from[i] == to[j] ? 0 : 1);
      above_left = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, above_left + 1});
    }
  }
  return row.back();
}

/// "did you mean WORD?" for the nearest of `known` where at most a third of the letters differ, or two; else
/// `otherwise`.
[[nodiscard]] inline std::string did_you_mean(std::string_view word, const std::vector<std::string>& known,
                                              const std::string& otherwise) {
  const std::string* nearest = nullptr;
  std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const std::size_t edits = edits_between(word, candidate);
    if (edits < least && edits < candidate.size()) nearest = &candidate, least = edits;
  }
  return nearest == nullptr ? otherwise : "did you mean " + *nearest + "?";
}

}  // namespace jaywalk
