#include "firmware/robot/stop_words.h"

#include <algorithm>
#include <array>

namespace jaywalk {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f", kNow = "now";

struct StopWord {
  std::string_view word;
  StopWords means;
};
constexpr std::array kStopWords{StopWord{"stop", StopWords::kStop}, StopWord{"halt", StopWords::kStop},
                                StopWord{"emergency", StopWords::kStopNow}, StopWord{"estop", StopWords::kStopNow},
                                StopWord{"e-stop", StopWords::kStopNow}};

char lower(char c) noexcept { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool is_same(char said, char want) noexcept { return lower(said) == want; }

bool begins_with(std::string_view line, std::string_view word) noexcept {
  return line.size() >= word.size() &&
         std::equal(word.begin(), word.end(), line.begin(), [](char want, char said) { return is_same(said, want); });
}

StopWords stop_in_line(std::string_view line) noexcept {
  const auto* const letter =
      std::find_if(line.begin(), line.end(), [](char c) { return lower(c) >= 'a' && lower(c) <= 'z'; });
  line.remove_prefix(static_cast<std::size_t>(letter - line.begin()));
  const auto* const found = std::find_if(kStopWords.begin(), kStopWords.end(),
                                         [line](const StopWord& row) { return begins_with(line, row.word); });
  if (found == kStopWords.end()) return StopWords::kNone;
  const bool now = std::search(line.begin(), line.end(), kNow.begin(), kNow.end(), is_same) != line.end();
  return now ? StopWords::kStopNow : found->means;
}

}  // namespace

std::string_view trimmed(std::string_view line) noexcept {
  const std::size_t begin = line.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return line.substr(begin, line.find_last_not_of(kBlanks) - begin + 1);
}

StopWords stop_in(std::string_view text) noexcept {
  StopWords found = StopWords::kNone;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    found = std::max(found, stop_in_line(text.substr(at, end - at)));
    at = end + 1;
  }
  return found;
}

}  // namespace jaywalk
