#pragma once
#include <algorithm>

#include "planner/motion/cost/prices.h"
#include "planner/motion/situation.h"

namespace jaywalk::motion {

/// Changes of speed and of turning, braking, turning itself, driving backward, and turning to the other side than last.
class ComfortCost {
 public:
  explicit ComfortCost(const Situation& s)
      : turned_(s.turned), change_share_(std::min(1.0F, price::kPricedAtMps / s.body.bounds.speed)) {}

  void add(const RobotState& before, const RobotState& now, Cost& cost) noexcept {
    const float dv = now.v - before.v, dw = now.w - before.w, side = now.v * now.w;
    cost.comfort += change_share_ * (price::kAccel * dv * dv + price::kTurnAccel * dw * dw) +
                    price::kTurning * now.w * now.w + price::kSideways * side * side;
    const float bite = now.braked - before.braked;
    cost.comfort += price::kBrake * bite * bite;
    if (now.v < -0.01F) cost.comfort += price::kBackward;
    const float turns = turned_side(now.w, turned_);
    if (turns * turned_ < 0.0F) cost.comfort += change_share_ * price::kReversal;
    turned_ = turns;
  }

 private:
  float turned_;  ///< to this side it turned last
  float change_share_;
};

}  // namespace jaywalk::motion
