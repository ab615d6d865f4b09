#pragma once
#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {

/// Unreliable first scans: taken from a robot that drove and was thought to stand, since scans alone know no speed
/// before the third. Their sweeps were not put right and their poses are off, so that for a second everything seems to
/// walk a little.
class FirstScans {
 public:
  /// Once a scan, with the robot's speed as it is thought to be at `now`. True while nothing can be said to walk: for a
  /// second after the speed jumped by more than a robot gains from one scan to the next.
  [[nodiscard]] bool are_unreliable(const Twist2& twist, Time now) noexcept;

 private:
  int scans_ = 0;
  Twist2 last_;
  Time jumped_ = kNever;
};

}  // namespace jaywalk
