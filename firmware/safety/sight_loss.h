#pragma once
#include "firmware/safety/blind_gaps.h"
#include "hal/types/time.h"

namespace jaywalk {

/// Whether so many beams prove nothing that the scanner has to be seen to (SAFETY 17): more than half of those that it
/// should measure, at once; more than a third of those within 60 degrees of the way ahead, for longer than a second.
class SightLoss {
 public:
  /// Once a tick.
  [[nodiscard]] bool is_lost(const BeamCounts& counts, Time now) noexcept;

 private:
  Time lost_ahead_since_ = kNever;
};

}  // namespace jaywalk
