#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "planner/cell/exp_log.h"
#include "planner/motion/cost/interaction.h"
#include "planner/motion/situation.h"
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

/// Movers: the chance of touching or forcing one, and nearness to them. They walk as they do, whatever the robot does.
class MoverCost {
 public:
  explicit MoverCost(const Situation& s)
      : s_(s), yielding_(1.0F / (1.0F + std::max(0.0F, s.stall.lost_s - price::kYieldsForS) / price::kYieldsLessS)) {}

  /// `step`: of the futures; `t`: seconds from now.
  void add(const RobotState& r, const cell::Heading& along, int step, float t, Cost& cost) noexcept {
    Sum all;
    const BodyDiscs& discs = s_.body.to_movers;
    const int at_step = step < kFutureSteps ? step : kFutureSteps - 1;
    for (std::size_t m = 0; m < s_.futures.movers(); ++m) {
      const MoverAt& at = s_.futures.at(at_step, m);
      const float radius = s_.futures.radius(m);
      const float most = at.spread + std::max(radius + kZoneM + discs.radius + 0.1F, s_.body.comfort_distance_m);
      for (int k = 0; k < discs.count; ++k) {
        const Place disc = disc_at(r, along, k);
        const float dx = disc.x - at.mid_x, dy = disc.y - at.mid_y;
        if (dx * dx + dy * dy < most * most) add_disc(r, disc, {k, m}, at, all);
      }
    }
    cost.nearness += (price::kNearMover * all.nearness + price::kTooFast * all.too_fast) /
                     static_cast<float>(kFutures * discs.count);
    price_meetings(all, rim_mps(r), t, cost);
  }

 private:
  /// Over all discs and movers.
  struct Sum {
    std::uint32_t met = 0, stood = 0, touched = 0;  ///< a bit a future; `stood`: met, of those that have stood for long
    float nearness = 0.0F, too_fast = 0.0F;
  };

  /// Numbers of a disc of the body and of a mover.
  struct Pair {
    int disc;
    std::size_t mover;
  };

  void add_disc(const RobotState& r, Place disc, Pair of, const MoverAt& at, Sum& all) const noexcept {
    const BodyDiscs& discs = s_.body.to_movers;
    const bool has_stood = s_.futures.has_stood(of.mover);  // a surface until it sets out: standing()
    const Interaction with = interaction(at, s_.futures.radius(of.mover), s_.futures.is_surface(of.mover),
                                         {disc.x, disc.y, discs.radius, std::fabs(r.v)}, s_.body.comfort_distance_m);
    (has_stood ? all.stood : all.met) |= with.met;
    if (with.touched != 0 && !has_stood && rim_mps(r) > kRestsMps) {
      const Place before = disc_at(s_.start, cell::heading_at(s_.start.heading), of.disc);
      all.touched |= nearer(with.touched, disc, at, before, s_.futures.at(0, of.mover));
    }
    // Nearness to standing movers is paid by the metre, so that waiting gains nothing.
    const float way = std::min(1.0F, rim_mps(r) / s_.body.bounds.speed);
    all.nearness += with.nearness + way * with.beside;
    if (!s_.futures.is_newcomer(of.mover)) all.too_fast += with.too_fast;
  }

  /// Each future's worst meeting counts: the sooner the worse, and contact the faster.
  void price_meetings(const Sum& all, float rim_mps, float t, Cost& cost) noexcept {
    if ((all.met | all.stood | all.touched) == 0) return;
    const float later = cell::exp(-t / price::kConflictFadesS);
    const float fast = std::min(1.0F, rim_mps / price::kTouchedAtMps);
    const float hard = later * (price::kTouchedSlowly + (1.0F - price::kTouchedSlowly) * fast);
    const float met_s = yielding_ * s_.conflict_price_s;
    cost.conflict += met_s * met_.add(all.met, later);
    cost.conflict += met_s * met_.add(all.stood & ~all.met, price::kStandingWeight * later);
    cost.conflict += (t > kSafeForS ? yielding_ : 1.0F) * price::kConflict * touched_.add(all.touched, hard);
    if (t > kSafeForS) return;
    hit_ |= all.touched;
    cost.hit_share = static_cast<float>(std::popcount(hit_)) / kFutures;
  }

  /// Speed of the body's fastest point, m/s, about.
  [[nodiscard]] float rim_mps(const RobotState& r) const noexcept {
    return std::fabs(r.v) + std::fabs(r.w) * s_.body.rim_m;
  }

  [[nodiscard]] Place disc_at(const RobotState& r, const cell::Heading& along, int k) const noexcept {
    const float ahead = s_.body.to_movers.ahead[static_cast<std::size_t>(k)];
    return {r.x + ahead * along.x, r.y + ahead * along.y};
  }

  const Situation& s_;
  /// Factor, 1 or less, on the prices of being in a mover's way and of touching later than kSafeForS:
  /// price::kYieldsForS.
  float yielding_;
  /// Touching is priced apart from being in a mover's way.
  WorstMeetings met_, touched_;
  std::uint32_t hit_ = 0;  ///< futures in which the moving robot touched a mover within kSafeForS: a bit each
};

}  // namespace jaywalk::motion
