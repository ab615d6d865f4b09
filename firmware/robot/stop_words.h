#pragma once
#include <cstdint>
#include <string_view>

namespace jaywalk {

enum class StopWords : std::uint8_t { kNone, kStop, kStopNow };

/// Returns the strongest stop in any line of `text`.
///
/// A line is a stop where its first letters are "stop" or "halt", in either case, whatever stands before and after
/// them. "emergency", "estop" and "e-stop", and "now" in the line, stop at once.
[[nodiscard]] StopWords stop_in(std::string_view text) noexcept;

/// Without the blanks, and the ends of lines, round it.
[[nodiscard]] std::string_view trimmed(std::string_view line) noexcept;

}  // namespace jaywalk
