#include "firmware/robot/stop_words.h"

#include <algorithm>

namespace jaywalk {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";

bool is_same(char a, char b) noexcept { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; }

}  // namespace

std::string_view trimmed(std::string_view line) noexcept {
  const std::size_t begin = line.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return line.substr(begin, line.find_last_not_of(kBlanks) - begin + 1);
}

StopWords stop_in(std::string_view text) noexcept {
  constexpr std::string_view kStop = "stop", kNow = "now";
  StopWords found = StopWords::kNone;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    const std::string_view line = trimmed(text.substr(at, end - at));
    at = end + 1;
    if (line.size() < kStop.size() ||
        !std::equal(kStop.begin(), kStop.end(), line.begin(), [](char want, char said) { return is_same(said, want); }))
      continue;
    const bool now = std::search(line.begin(), line.end(), kNow.begin(), kNow.end(), is_same) != line.end();
    found = std::max(found, now ? StopWords::kStopNow : StopWords::kStop);
  }
  return found;
}

}  // namespace jaywalk
