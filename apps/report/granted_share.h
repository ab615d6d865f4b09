#pragma once
#include <algorithm>
#include <limits>

#include "firmware/recording/tick_record.h"

namespace jaywalk {

/// How much of what a person's stick asked for was permitted.
class GrantedShare {
 public:
  void add(const TickRecord& t) noexcept {
    if (last_ != kNever && steered_) steered_s_ += to_seconds(t.now - last_);
    last_ = t.now, steered_ = t.input.steers;
    if (t.wished == Twist2{}) return;
    sum_ += share_of(t.wished, t.verdict.permitted);
    ++ticks_;
  }
  /// Over all ticks with a stick out of its middle, 0 to 1; NaN without one.
  [[nodiscard]] double mean() const noexcept {
    return ticks_ == 0 ? std::numeric_limits<double>::quiet_NaN() : sum_ / static_cast<double>(ticks_);
  }
  [[nodiscard]] double steered_s() const noexcept { return steered_s_; }

  /// The permitted twist's part along the wished one, 0 to 1; a rad/s counts as half a m/s.
  [[nodiscard]] static double share_of(const Twist2& wished, const Twist2& permitted) noexcept {
    constexpr double kArm2_m2 = 0.25;
    const double along = permitted.v_mps * wished.v_mps + kArm2_m2 * permitted.w_radps * wished.w_radps;
    const double whole = wished.v_mps * wished.v_mps + kArm2_m2 * wished.w_radps * wished.w_radps;
    return std::clamp(along / whole, 0.0, 1.0);
  }

 private:
  double sum_ = 0.0, steered_s_ = 0.0;
  std::uint64_t ticks_ = 0;
  bool steered_ = false;
  Time last_ = kNever;
};

}  // namespace jaywalk
