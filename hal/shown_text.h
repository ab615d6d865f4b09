#pragma once
#include <algorithm>
#include <charconv>
#include <cstdarg>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/types/errors.h"

namespace jaywalk {

/// The first 40 characters of a stranger's text, for messages: '?' for each that a terminal might obey.
[[nodiscard]] inline std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 40;
  std::string out(text.substr(0, kMost));
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text.size() > kMost ? out + "..." : out;
}

/// For a person: "-0", "-0.00" become "0", "0.00" wherever a number in `text` is that.
[[nodiscard]] inline std::string without_minus_zero(std::string text) {
  const auto is_of_number = [](char c) { return (c >= '0' && c <= '9') || c == '.'; };
  const auto is_of_word = [&](char c) { return is_of_number(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  for (std::size_t at = 0; (at = text.find("-0", at)) != std::string::npos; ++at) {
    std::size_t end = at + 1;
    while (end < text.size() && (text[end] == '0' || text[end] == '.')) ++end;
    const bool more = end < text.size() && (is_of_number(text[end]) || text[end] == 'e' || text[end] == 'x');
    if (!more && (at == 0 || !is_of_word(text[at - 1]))) text.erase(at, 1);
  }
  return text;
}

/// As std::printf writes it, without_minus_zero; cut after 511 characters.
[[nodiscard, gnu::format(printf, 1, 2)]] inline std::string formatted(const char* format, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return without_minus_zero(text);
}

/// The whole of `word` as a number; nothing where it is none, or out of the range of `T`.
template <class T>
[[nodiscard]] std::optional<T> number_in(std::string_view word) noexcept {
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() ? std::optional(value) : std::nullopt;
}

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

/// "did you mean WORD?" for the nearest of `known`, of which two letters or a third may differ; else `otherwise`.
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
