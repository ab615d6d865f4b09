#pragma once
#include <cstdint>

#include "planner/prediction/futures.h"

namespace jaywalk::motion {

/// The worst level at which the robot meets movers, in each future. A later meeting counts as far as it is worse.
class WorstMeetings {
 public:
  /// `futures`: those with a meeting now, a bit each. Returns how much worse that is, as a share of all futures.
  [[nodiscard]] float add(std::uint32_t futures, float level) noexcept {
    if (futures == 0) return 0.0F;
    float worse = 0.0F;
    for (int k = 0; k < kFutures; ++k) {
      const float more = (futures >> k & 1U) != 0 && level > worst_[k] ? level - worst_[k] : 0.0F;
      worst_[k] += more;
      worse += more;
    }
    return worse / kFutures;
  }

 private:
  float worst_[kFutures] = {};
};

}  // namespace jaywalk::motion
