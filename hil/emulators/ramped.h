#pragma once
#include <algorithm>

namespace jaywalk::emulators {

/// `from`, moved towards `to` by `most` at most.
[[nodiscard]] inline double ramped(double from, double to, double most) noexcept {
  return from < to ? std::min(from + most, to) : std::max(from - most, to);
}

}  // namespace jaywalk::emulators
