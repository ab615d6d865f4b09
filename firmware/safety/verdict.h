#pragma once
#include <cstdint>

#include "firmware/safety/reasons.h"
#include "hal/types/geometry.h"

namespace jaywalk {

/// What the supervisor permits this tick, and why it is not what was wanted.
struct Verdict {
  Twist2 permitted;
  Reason reasons = Reason::kNone;
  double gap_m = 0.0;                ///< free way ahead in the direction of travel, +inf when nothing is in it
  std::uint8_t faulty_scanners = 0;  ///< of several, bit k: a fault of scans is scanner k's

  [[nodiscard]] bool is_faulty(std::size_t scanner) const noexcept { return ((faulty_scanners >> scanner) & 1U) != 0; }
};

}  // namespace jaywalk
