#pragma once
#include <algorithm>
#include <cstdarg>
#include <cstdio>
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

/// As std::printf writes it, without_minus_zero; cut after 255 characters.
[[nodiscard, gnu::format(printf, 1, 2)]] inline std::string formatted(const char* format, ...) {
  char text[256];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return without_minus_zero(text);
}

}  // namespace jaywalk
