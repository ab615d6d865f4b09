#pragma once
#include <algorithm>
#include <cmath>

#include "hal/types/robot_model.h"
#include "planner/cell/cell.h"
#include "planner/motion/cost/prices.h"
#include "planner/motion/situation.h"

namespace jaywalk::motion {

/// Touching surfaces, and driving near them. A pedestrian that has stood for long is a surface, too.
class WallCost {
 public:
  explicit WallCost(const Situation& s)
      : s_(s), at_start_(clearance_at(s.start, cell::heading_at(s.start.heading))), clearance_(at_start_) {}

  /// `t`: seconds from now.
  void add(const RobotState& now, const cell::Heading& along, float t, Cost& cost) noexcept {
    const float c = clearance_at(now, along);
    // It may always leave what it stands beside, swinging as near as the supervisor lets it.
    using Rules = StopZoneRules<float>;
    const bool nears = c < clearance_ - 1e-4F && (c < at_start_ - Rules::kSwing_m || c < Rules::kLeast_m);
    clearance_ = c;
    if (c < price::kContactM && nears) {
      const float deep = (price::kContactM - c) * 20.0F;
      cost.touch += price::kNearContact * cell::exp(-0.2F * t) * (deep < 1.0F ? deep : 1.0F) +
                    (c < 0.0F ? price::kContact : 0.0F);
    }
    if (c < price::kByWallM) cost.clearance += kStepS * paid_share(now) * near_price(c);
  }

 private:
  [[nodiscard]] bool is_steered() const noexcept { return s_.stick != nullptr; }

  [[nodiscard]] float near_price(float c) const noexcept {
    const float close = c < price::kNearWallM ? (price::kNearWallM - c) / price::kNearWallM : 0.0F;
    const float by_wall = is_steered() ? 0.0F : price::kByWall * (price::kByWallM - c) / price::kByWallM;
    return price::kNearWall * close * close + by_wall;
  }

  /// Share of the price near surfaces: 1 on the way to a goal, so that the robot leaves a wall that it stands beside;
  /// in proportion to the speed of the body's edge while a stick steers, so that waiting costs nothing.
  [[nodiscard]] float paid_share(const RobotState& r) const noexcept {
    return is_steered() ? std::min(1.0F, s_.body.rim_mps(r) / s_.body.bounds.speed) : 1.0F;
  }

  [[nodiscard]] float clearance_at(const RobotState& r, const cell::Heading& along) const noexcept {
    const float least = s_.body.to_walls.clearance(s_.guide, r.x, r.y, along);
    const bool coarse = !(is_steered() || s_.goes_by_poses()) || least >= price::kByWallM;
    return std::min(coarse ? least : s_.body.outline.clearance(s_.guide, r.x, r.y, along),
                    clearance_to_standing(r, along));
  }

  /// A pedestrian that has stood for long is a surface as wide as a body, though the map has the shins alone.
  [[nodiscard]] float clearance_to_standing(const RobotState& r, const cell::Heading& along) const noexcept {
    float least = Guide::kFar_m;
    for (const StandingDisc& disc : s_.futures.standing()) {
      const float dx = disc.x - r.x, dy = disc.y - r.y;
      const float ahead = dx * along.x + dy * along.y, left = dy * along.x - dx * along.y;
      least = std::min(least, s_.body.gap(ahead, left) - disc.radius);
    }
    return least;
  }

  const Situation& s_;
  float at_start_, clearance_;
};

/// Parts of the body where nothing was ever seen.
class UnseenCost {
 public:
  explicit UnseenCost(const Situation& s) : s_(s) {}

  void add(const RobotState& r, const cell::Heading& along, Cost& cost) noexcept {
    if (r.v > 0.0F) driven_m_ += r.v * kStepS;
    int parts = 0;
    for (const Place& p : s_.body.rim) {
      const float x = r.x + p.x * along.x - p.y * along.y, y = r.y + p.x * along.y + p.y * along.x;
      parts += !stood_on(x, y) && s_.guide.is_unseen(x, y) ? 1 : 0;
    }
    if (parts == 0) return;
    const bool is_dared = s_.goes_by_poses() ? s_.poses->through_unseen : s_.guide.through_unseen;
    const float price = is_dared ? price::kUnseenDared + price::kUnseenTurned * std::fabs(r.w)
                                 : price::kUnseen * cell::exp(-driven_m_ / price::kUnseenFadesM);
    cost.unseen += price * kStepS * static_cast<float>(parts) * 0.125F;
  }

 private:
  /// Whether a place is within kStoodOnM of the axle at the start: such ground counts as seen.
  [[nodiscard]] bool stood_on(float x, float y) const noexcept {
    const float dx = x - s_.start.x, dy = y - s_.start.y;
    return dx * dx + dy * dy < price::kStoodOnM * price::kStoodOnM;
  }

  const Situation& s_;
  float driven_m_ = 0.0F;  ///< forward
};

/// The supervisor's part in a trajectory: it slows the robot near surfaces that the last scan hit, and where the laser
/// does not look.
class StopZoneCost {
 public:
  explicit StopZoneCost(const Situation& s) : s_(s) {}

  /// Slows a step from `before` to `now` as the supervisor will, near what the map may not have.
  void limit(const RobotState& before, RobotState& now, Cost& cost) noexcept {
    cost.stop_zone += price::kBlindRim * s_.body.blind.too_fast(now.v, now.w);
    const float rim_mps = s_.body.rim_mps(now);
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
