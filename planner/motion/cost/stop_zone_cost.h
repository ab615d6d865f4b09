#pragma once
#include <cmath>

#include "planner/cell/exp_log.h"
#include "planner/motion/cost/prices.h"
#include "planner/motion/situation.h"

namespace jaywalk::motion {

/// What the supervisor would brake: so fast so near a surface, or to where the laser does not look.
class StopZoneCost {
 public:
  explicit StopZoneCost(const Situation& s) : s_(s) {}

  /// `clearance_m`: to the nearest surface; `t`: seconds from now. Of the brakings near surfaces the dearest counts.
  void add(const RobotState& now, float clearance_m, float t, Cost& cost) noexcept {
    // Near what stands there may be walls that the map does not have.
    if (s_.goes_by_poses()) t = moved_s_ += moves(now) ? kStepS : 0.0F;  // or it would wait to go for ever
    if ((clearance_m < price::kByWallM || s_.goes_by_poses()) && t < NearReturns::kForS) {
      const float share = s_.returns.braked_share(now, s_.body);
      // Squared there: a body that goes by poses passes near by nature.
      const float price = price::kStopZone * cell::exp(-t) * share * (s_.goes_by_poses() ? share : 1.0F);
      if (price > paid_) cost.stop_zone += price - paid_, paid_ = price;
    }
    cost.stop_zone += price::kBlindRim * s_.body.blind.too_fast(now.v, now.w);
  }

 private:
  [[nodiscard]] bool moves(const RobotState& now) const noexcept {
    return std::fabs(now.v) + std::fabs(now.w) * s_.body.rim_m > kRestsMps;
  }

  const Situation& s_;
  float paid_ = 0.0F;
  float moved_s_ = 0.0F;  ///< of the trajectory so far
};

}  // namespace jaywalk::motion
