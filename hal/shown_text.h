#pragma once
#include <algorithm>
#include <string>
#include <string_view>

namespace jaywalk {

/// What of a stranger's `text` a message may hold: its first 40 characters, '?' for each that a terminal might obey
/// rather than print.
[[nodiscard]] inline std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 40;
  std::string out(text.substr(0, kMost));
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text.size() > kMost ? out + "..." : out;
}

/// The whole of it, with '?' for each control character; letters of other alphabets stay.
[[nodiscard]] inline std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return (c >= '\0' && c < ' ') || c == '\x7F'; }, '?');
  return text;
}

}  // namespace jaywalk
