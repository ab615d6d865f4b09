#pragma once
#include <algorithm>

#include "planner/cell/cell.h"
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

/// The time that a trajectory takes, and from its end to the goal; and what it costs not to get on. Waiting for a while
/// may look best again and again: the longer the time to go has not fallen below the least so far, the dearer are all
/// seconds beside movers, standing, circling and backing off alike; with no pedestrian about, those until it falls
/// (docs/explanation/decisions/motion-prices.md).
class TimeCost {
 public:
  explicit TimeCost(const Situation& s) : s_(s), waits_(s.stall.is_alone && has_way()) {
    const float stood_s = std::min(s.stall.for_s, waits_ ? price::kMostAloneS : price::kMostStoodS);
    extra_ = has_way() ? price::kImpatience * stood_s : 0.0F;
  }

  void add(const RobotState& now, Cost& cost) noexcept {
    waits_ = waits_ && !s_.stall.gets_on(s_.time_to_go(now));
    const bool is_dearer = waits_ || !s_.stall.is_alone;
    cost.time += is_dearer ? kStepS * (1.0F + extra_) : kStepS;
  }

  /// What the way from where a trajectory ends costs.
  [[nodiscard]] float price_to_go(const RobotState& end) const noexcept {
    return unwinding_s(end) + (s_.stall.is_alone ? to_go(end) : (1.0F + extra_) * to_go(end));
  }

  [[nodiscard]] bool is_there(const RobotState& now) const noexcept {
    if (!s_.rests_at_goal(now)) return false;
    // A robot that turns past the heading has yet to turn back.
    return !s_.wants_heading || (s_.off_heading(now.heading) < s_.faces_rad && std::fabs(now.w) < price::kFacesRadps);
  }

 private:
  [[nodiscard]] bool has_way() const noexcept { return s_.time_to_go(s_.start) < Guide::kNoWay_s; }
  [[nodiscard]] float unwinding_s(const RobotState& end) const noexcept {
    const float wound = std::fabs(s_.stall.wound_rad + end.heading - s_.start.heading);
    return price::kWound * std::max(0.0F, wound - cell::kPiF);
  }
  /// Seconds from where a trajectory ends, and a second for facing across the way there, two for facing back.
  [[nodiscard]] float to_go(const RobotState& end) const noexcept {
    const float there = s_.time_to_go(end);
    if (there >= Guide::kNoWay_s) return price::kMostTimeToGoS;
    if (s_.goes_by_poses() || (s_.wants_heading && s_.is_at_goal(end))) return there;
    const cell::Heading along = cell::heading_at(end.heading);
    const float ahead = s_.guide.time_to_go(end.x + price::kFacingM * along.x, end.y + price::kFacingM * along.y);
    const float here = s_.guide.time_to_go(end.x, end.y);
    const float gained = here - (ahead < here + 1.0F ? ahead : here + 1.0F);
    const float facing = gained * s_.body.bounds.speed / price::kFacingM;
    return there + (1.0F - facing);
  }

  const Situation& s_;
  bool waits_;          ///< alone, it has not got on yet
  float extra_ = 0.0F;  ///< for a second
};

}  // namespace jaywalk::motion
