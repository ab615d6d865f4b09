#pragma once
#include <cmath>

#include "planner/motion/cost/prices.h"
#include "planner/motion/situation.h"

namespace jaywalk::motion {

/// The supervisor's part in a trajectory: it slows the robot near surfaces that the last scan hit, and where the laser
/// does not look.
class StopZoneCost {
 public:
  explicit StopZoneCost(const Situation& s) : s_(s) {}

  /// Slows a step from `before` to `now` as the supervisor will, near what the map may not have.
  void limit(const RobotState& before, RobotState& now, Cost& cost) noexcept {
    cost.stop_zone += price::kBlindRim * s_.body.blind.too_fast(now.v, now.w);
    const float rim_mps = std::fabs(now.v) + std::fabs(now.w) * s_.body.rim_m;
    if (foreseen_ == 0 || rim_mps < kRestsMps) return;
    --foreseen_;
    const float share = s_.returns.braked_share(now, s_.body);
    if (share <= 0.0F) return;
    cost.stop_zone += price::kTakenAway * share * rim_mps;
    now.v *= 1.0F - share, now.w *= 1.0F - share, now.accel = 0.0F;
    place_after(before, now, kStepS);
  }

 private:
  const Situation& s_;
  int foreseen_ = static_cast<int>(NearReturns::kForS / kStepS);  ///< moving steps, as far as the last scan reaches
};

}  // namespace jaywalk::motion
