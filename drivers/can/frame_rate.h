#pragma once
#include <algorithm>

#include "hal/types/time.h"

namespace jaywalk {

/// Token bucket over a frame that one device alone sends: a second device of the same number shows as one too many.
///
/// Half as many again as are due may come: a device's clock may be fast, and CAN repeats a frame whose last bit was
/// disturbed (ISO 11898-1). Two devices send twice as many, and empty the store of three with the fourth pair.
class FrameRate {
 public:
  /// So many became due, as one with each SYNC.
  void expect(double frames) noexcept { store_ = std::min(store_ + kShare * frames, kStore); }
  /// One came; false where it is one too many.
  [[nodiscard]] bool take() noexcept {
    if (store_ < 1.0) return false;
    store_ -= 1.0;
    return true;
  }
  /// The same of a frame that is due once a period.
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
