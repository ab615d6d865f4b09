#pragma once
#include <cstdint>
#include <string_view>

namespace jaywalk {

enum class StopWords : std::uint8_t { kNone, kStop, kStopNow };

/// The strongest stop among the lines of `text`. A person who wants it to stop is in a hurry: each line whose first
/// letters are "stop", "halt" or "emergency" is one, in any case, whatever stands before them and follows; with "now"
/// in it, and an emergency, at once.
[[nodiscard]] StopWords stop_in(std::string_view text) noexcept;

/// Without the blanks, and the ends of lines, round it.
[[nodiscard]] std::string_view trimmed(std::string_view line) noexcept;

}  // namespace jaywalk
