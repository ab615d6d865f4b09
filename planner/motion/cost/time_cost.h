#pragma once
#include <algorithm>

#include "planner/cell/circle.h"
#include "planner/motion/cost/prices.h"
#include "planner/motion/situation.h"

namespace jaywalk::motion {

/// The time that a trajectory takes, and from its end to the goal; and what it costs to stand on. Waiting for a while
/// may look best again and again: the longer the robot has made no progress, the dearer waiting is. With no pedestrian
/// about, backing off and returning counts as waiting, too (docs/explanation/decisions/motion-prices.md).
class TimeCost {
 public:
  explicit TimeCost(const Situation& s) : s_(s), waits_(s.time_to_go(s.start) < Guide::kNoWay_s) {}

  void begin(Cost& cost) const noexcept { cost.time = price::kArrivedEarly; }

  void add(const RobotState& now, Cost& cost) noexcept {
    if (waits_) wait(now, cost);
    cost.time += kStepS;
  }

  [[nodiscard]] bool is_there(const RobotState& now) const noexcept {
    return is_at_goal(now) && (!s_.wants_heading || off_heading(now) < price::kFacesRad);
  }

  /// Seconds from where a trajectory ends, and a second for facing across the way there, two for facing back.
  [[nodiscard]] float to_go(const RobotState& end) const noexcept {
    const float there = s_.time_to_go(end);
    if (there >= Guide::kNoWay_s) return price::kMostTimeToGoS;
    if (s_.goes_by_poses()) return there;
    if (s_.wants_heading && is_at_goal(end)) return off_heading(end) / price::kTurnAtGoalRadps;
    const cell::Heading along = cell::heading_at(end.heading);
    const float ahead = s_.guide.time_to_go(end.x + price::kFacingM * along.x, end.y + price::kFacingM * along.y);
    const float gained = there - (ahead < there + 1.0F ? ahead : there + 1.0F);
    const float facing = gained * s_.body.bounds.speed / price::kFacingM;
    return there + (1.0F - facing);
  }

 private:
  [[nodiscard]] bool is_at_goal(const RobotState& now) const noexcept {
    const float dx = now.x - s_.goal.x, dy = now.y - s_.goal.y;
    return dx * dx + dy * dy < s_.arrives_within_m * s_.arrives_within_m;
  }
  [[nodiscard]] float off_heading(const RobotState& now) const noexcept {
    return std::fabs(cell::wrapped(s_.goal_heading - now.heading));
  }

  void wait(const RobotState& now, Cost& cost) noexcept {
    const float least = s_.stall.least_to_go_s;
    waits_ = least > 0.0F ? s_.time_to_go(now) > least - kGetsOnS : s_.stall.holds(now);
    const float most_s = least > 0.0F ? price::kMostAloneS : price::kMostStoodS;
    if (waits_) cost.time += kStepS * price::kImpatience * std::min(s_.stall.for_s, most_s);
  }

  const Situation& s_;
  bool waits_;  ///< it has made no progress yet, though there is a way
};

}  // namespace jaywalk::motion
