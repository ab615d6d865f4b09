#pragma once
#include <algorithm>

#include "hal/types/time.h"

namespace jaywalk {

/// How long a condition has held without a break, by the times at which it was looked at, however often that was.
class HeldTime {
 public:
  /// Between two updates at most so much counts: it was not looked at in between.
  static constexpr Duration kLongestGap = std::chrono::milliseconds(500);

  /// Whether it holds at `now`; where it does not, the time begins anew.
  void update(bool holds, Time now) noexcept {
    if (!holds) return forget();
    if (before_ != kNever) total_ += std::min(now - before_, kLongestGap);
    before_ = now;
  }
  /// The time from here to the next update does not count.
  void pause() noexcept { before_ = kNever; }
  void forget() noexcept {
    total_ = Duration{0};
    before_ = kNever;
  }
  [[nodiscard]] Duration total() const noexcept { return total_; }

 private:
  Duration total_{0};
  Time before_ = kNever;
};

}  // namespace jaywalk
