#pragma once
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
    if (clearance_m < price::kByWallM && t < NearReturns::kForS) {
      const float price = price::kStopZone * cell::exp(-t) * s_.returns.braked_share(now, s_.body);
      if (price > paid_) cost.stop_zone += price - paid_, paid_ = price;
    }
    cost.stop_zone += price::kBlindRim * s_.body.blind.too_fast(now.v, now.w);
  }

 private:
  const Situation& s_;
  float paid_ = 0.0F;
};

}  // namespace jaywalk::motion
