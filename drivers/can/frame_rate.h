#pragma once
#include <algorithm>

#include "hal/types/time.h"

namespace jaywalk {

/// Token bucket that detects two devices with the same number by the rate of a frame that only one device may send.
///
/// The bucket fills at 1.5 times the due rate. A device's clock may be fast, and CAN repeats a frame after a disturbed
/// last bit (ISO 11898-1). Two devices send at twice the due rate: their fourth pair finds the bucket empty.
class FrameRate {
 public:
  /// Adds tokens for frames that became due, such as one with each SYNC.
  void expect(double frames) noexcept { store_ = std::min(store_ + kShare * frames, kStore); }
  /// Takes a token for a frame that came; false where none is left.
  [[nodiscard]] bool take() noexcept {
    if (store_ < 1.0) return false;
    store_ -= 1.0;
    return true;
  }
  /// Takes a token for a frame that is due once a period.
  [[nodiscard]] bool take_at(Time stamp, Duration period) noexcept {
    if (last_ != kNever) expect(to_seconds(stamp - last_) / to_seconds(period));
    last_ = stamp;
    return take();
  }

 private:
  static constexpr double kShare = 1.5, kStore = 3.0;  ///< frames

  double store_ = kStore;
  Time last_ = kNever;
};

}  // namespace jaywalk
