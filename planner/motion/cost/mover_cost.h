#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "planner/cell/cell.h"
#include "planner/motion/cost/prices.h"
#include "planner/motion/situation.h"
#include "planner/prediction/futures.h"

namespace jaywalk::motion {

inline constexpr float kMoverMarginM = 0.035F;
inline constexpr float kZoneM = 0.5F + 0.1F;  ///< before a mover: where it would turn away, and a margin
inline constexpr float kZoneSideM = 0.013F;

/// Relation of a disc of the robot to one mover, in all sampled futures at once; sets of futures are a bit each.
struct Interaction {
  std::uint32_t met = 0;  ///< touched, or in the quarter circle before the mover while that walks
  std::uint32_t touched = 0;
  float nearness = 0.0F;  ///< to those that walk, a sum over futures, m2
  float beside = 0.0F;    ///< the same of those that stand
  float too_fast = 0.0F;  ///< beside it while it stands: m/s over what is polite, a sum over futures
};

/// A disc of the robot, and how fast that drives.
struct MovingDisc {
  float x, y, radius_m, speed_mps;
};

inline Interaction interaction(const MoverAt& at, float mover_m, bool is_surface, const MovingDisc& disc,
                               float comfort_m) noexcept {
  const float touch = mover_m + disc.radius_m + kMoverMarginM, touch2 = touch * touch;
  const float zone = mover_m + kZoneM, edge = disc.radius_m + kZoneSideM;
  const float comfort2 = comfort_m * comfort_m;
  const float reach2 = (zone + edge) * (zone + edge), edge2 = edge * edge;
  alignas(32) std::int32_t hit[kFutures], faced[kFutures];
  alignas(32) float near[kFutures], fast[kFutures];
  for (int k = 0; k < kFutures; ++k) {
    const float dx = disc.x - at.x[k], dy = disc.y - at.y[k], d2 = dx * dx + dy * dy;
    const float ahead = dx * at.along_x[k] + dy * at.along_y[k];
    const float left = dy * at.along_x[k] - dx * at.along_y[k], aside = left < 0.0F ? -left : left;
    // Along the quarter circle's side, and off it; beyond the side a disc still reaches in.
    const float along = (ahead + aside) * 0.70710678F, off = (aside - ahead) * 0.70710678F;
    const float over = edge2 - off * off;
    const float first = along - std::sqrt(over > 0.0F ? over : 0.0F);
    const std::int32_t inside = (aside <= ahead) & (d2 < reach2);
    const std::int32_t beside = (aside > ahead) & (along > 0.0F) & (over > 0.0F) & (first < zone);
    hit[k] = d2 < touch2 ? 1 : 0;
    faced[k] = inside | beside;
    near[k] = d2 < comfort2 ? comfort2 - d2 : 0.0F;
    const float gap = std::sqrt(d2) - mover_m - disc.radius_m;  // it may set out, and be there within a second
    const float polite = gap < price::kPoliteMps ? price::kPoliteMps : gap;
    fast[k] = disc.speed_mps > polite ? disc.speed_mps - polite : 0.0F;
  }
  Interaction sum;
  std::uint32_t touched = 0, in_zone = 0;
  for (int k = 0; k < kFutures; ++k) {
    touched |= static_cast<std::uint32_t>(hit[k]) << k;
    in_zone |= static_cast<std::uint32_t>(faced[k]) << k;
    const bool walks = (at.walks >> k & 1U) != 0;
    sum.nearness += walks ? near[k] : 0.0F;
    sum.beside += walks ? 0.0F : near[k];
    sum.too_fast += walks ? 0.0F : fast[k];
  }
  sum.touched = is_surface ? touched & at.walks : touched;
  sum.met = sum.touched | (in_zone & at.walks);
  return sum;
}

/// Those of `futures` in which the disc is nearer to the mover `at` than it was at `before` to the same mover, `was`.
inline std::uint32_t nearer(std::uint32_t futures, Place disc, const MoverAt& at, Place before,
                            const MoverAt& was) noexcept {
  const auto distance2 = [](Place p, const MoverAt& mover, int k) {
    const float dx = p.x - mover.x[k], dy = p.y - mover.y[k];
    return dx * dx + dy * dy;
  };
  std::uint32_t are = 0;
  for (int k = 0; k < kFutures; ++k)
    are |= static_cast<std::uint32_t>(distance2(disc, at, k) < distance2(before, was, k) ? 1 : 0) << k;
  return futures & are;
}

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
    for (std::size_t m = 0; m < s_.futures.movers().size(); ++m) {
      const MoverAt& at = s_.futures.at(at_step, m);
      const float radius = s_.futures.movers()[m].radius_m;
      const float most = at.spread + std::max(radius + kZoneM + discs.radius + 0.1F, s_.body.comfort_distance_m);
      for (int k = 0; k < discs.count; ++k) {
        const Place disc = disc_at(r, along, k);
        const float dx = disc.x - at.mid_x, dy = disc.y - at.mid_y;
        if (dx * dx + dy * dy < most * most) add_disc(r, k, disc, m, at, all);
      }
    }
    cost.nearness += (price::kNearMover * all.nearness + price::kTooFast * all.too_fast) /
                     static_cast<float>(kFutures * discs.count);
    price_meetings(all, s_.body.rim_mps(r), t, cost);
  }

 private:
  /// Over all discs and movers.
  struct Sum {
    std::uint32_t met = 0, stood = 0, touched = 0;  ///< a bit a future; `stood`: met, of those that have stood for long
    float nearness = 0.0F, too_fast = 0.0F;
  };

  /// `k`: number of a disc of the body, at `disc`; `m`: of a mover, at `at`.
  void add_disc(const RobotState& r, int k, Place disc, std::size_t m, const MoverAt& at, Sum& all) const noexcept {
    const Futures::Mover& mover = s_.futures.movers()[m];
    const Interaction with =
        interaction(at, mover.radius_m, mover.is_surface, {disc.x, disc.y, s_.body.to_movers.radius, std::fabs(r.v)},
                    s_.body.comfort_distance_m);
    (mover.has_stood ? all.stood : all.met) |= with.met;  // a surface until it sets out: standing()
    if (with.touched != 0 && !mover.has_stood && s_.body.rim_mps(r) > kRestsMps) {
      const Place before = disc_at(s_.start, cell::heading_at(s_.start.heading), k);
      all.touched |= nearer(with.touched, disc, at, before, s_.futures.at(0, m));
    }
    // Nearness to standing movers is paid by the metre, so that waiting gains nothing.
    const float way = std::min(1.0F, s_.body.rim_mps(r) / s_.body.bounds.speed);
    all.nearness += with.nearness + way * with.beside;
    if (!mover.is_newcomer) all.too_fast += with.too_fast;
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
