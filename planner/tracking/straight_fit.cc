#include "planner/tracking/straight_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planner/tracking/target.h"

namespace jaywalk {
namespace {
constexpr double kWalkMps = 1.5;
constexpr double kLongestGapS = 0.13;                 // a target unseen for longer may be another
constexpr double kNoiseM = 0.01, kNoiseWeighs = 4.0;  // of a position an axis, as if known from so many
constexpr double kRoundOffM2 = 1e-12;  // scatter of positions that are all the same, a micrometre's square

/// Of `n` positions an axis, from what a walk leaves of their scatter: 2 n numbers, of which 4 went into the walk.
double noise_variance(double left_m2, double n) {
  return (left_m2 + kNoiseWeighs * kNoiseM * kNoiseM) / (2.0 * n - 4.0 + kNoiseWeighs);
}

constexpr double kSolidSigmas = 7.0, kThingSigmas = 15.0;
// The same of bodies that came to free space: no false mover in no_people_left.
constexpr double kCameSigmas = 4.5, kCameM = 0.06;
constexpr double kRigidShare = 0.3;  // of its walk is all that its width changes by
// Least length of a steady walk, in changes of the target's width: a surface that comes into view on one side and
// leaves it on the other seems to walk, at a quarter of the headings of no_people_left. 1.5 to 3 give the same.
constexpr double kGrew = 2.0;

/// The least of a steady walk that is believed.
struct LeastWalk {
  double sigmas = 0.0, length_m = 0.0;
};

LeastWalk least_walk(const Target& e, const StraightFit& fit) {
  if (!e.appearance.solid()) return {kThingSigmas, kSteadyM};
  if (e.onset.came_to_free_space() && fit.explained > kStraightExplains) return {kCameSigmas, kCameM};
  return {kSolidSigmas, kSteadyM};
}

}  // namespace

/// Takes positions from the newest on backwards, and fits a walk to those that it has.
class PositionHistory::Fit {
 public:
  explicit Fit(const Position& newest) : newest_(newest), last_(newest) {}

  void add(const Position& position) noexcept {
    const double t = to_seconds(position.when - newest_.when);
    const Vec2 p = position.seen.where_in_map - newest_.seen.where_in_map;
    n_ += 1.0, t_ += t, tt_ += t * t, pp_ += dot(p, p);
    p_ = p_ + p, tp_ = tp_ + p * t;
    if (fit_.positions > 0) fit_.longest_hop_m = std::max(fit_.longest_hop_m, hop(position, last_));
    fit_.positions += 1;
    fit_.duration_s = -t;
    fit_.spacing_m = std::max(fit_.spacing_m, position.seen.spacing_m);
    if (position.seen.whole) {
      fit_.whole_positions += 1;
      widest_whole_m_ = std::max(widest_whole_m_, position.seen.width_m);
      narrowest_m_ = std::min(narrowest_m_, position.seen.width_m);
    }
    last_ = position;
  }

  [[nodiscard]] StraightFit result() const noexcept {
    StraightFit fit = fit_;
    const double tt = tt_ - t_ * t_ / n_, scatter = pp_ - dot(p_, p_) / n_;
    if (fit.positions < 3 || !(tt > 0.0) || scatter < kRoundOffM2) return fit;
    const Vec2 tp = tp_ - p_ * (t_ / n_), velocity = tp * (1.0 / tt);
    const double explained = dot(velocity, tp);
    fit.length_m = norm(velocity) * fit.duration_s;
    fit.explained = explained / scatter;
    fit.sigmas = norm(velocity) * std::sqrt(tt / noise_variance(std::max(scatter - explained, 0.0), n_));
    fit.width_change_m = std::max(0.0, widest_whole_m_ - narrowest_m_);
    return fit;
  }

 private:
  /// How much farther it is from the position before to `position` than a walker comes in the time.
  [[nodiscard]] static double hop(const Position& before, const Position& position) noexcept {
    const double walked_s = std::min(to_seconds(position.when - before.when), kLongestGapS);
    return distance(before.seen.where_in_map, position.seen.where_in_map) - kWalkMps * walked_s;
  }

  Position newest_, last_;  ///< last added: the oldest
  StraightFit fit_;         ///< what needs no fit
  double narrowest_m_ = std::numeric_limits<double>::infinity(), widest_whole_m_ = 0.0;
  double n_ = 0.0, t_ = 0.0, tt_ = 0.0, pp_ = 0.0;  ///< sums; times and positions less the newest
  Vec2 p_, tp_;
};

void PositionHistory::add(Time when, const Sample& seen) noexcept {
  if (count_ > 0 && when - at(count_ - 1).since < kApart) {
    Position& newest = positions_[(count_ - 1) % kPositions];
    const Vec2 before = newest.seen.where_in_map;
    newest.scans += 1;
    newest.when += (when - newest.when) / newest.scans;
    newest.seen = seen;
    newest.seen.where_in_map = before + (seen.where_in_map - before) * (1.0 / newest.scans);
    return;
  }
  positions_[count_ % kPositions] = {when, when, seen, 1};
  ++count_;
}

std::size_t PositionHistory::first() const noexcept {
  std::size_t k = count_ - std::min(count_, kPositions);
  while (k + 1 < count_ && at(count_ - 1).when - at(k).when > kRemembers) ++k;
  return k;
}

StraightFit PositionHistory::fit() const noexcept {
  if (count_ == 0) return {};
  Fit fit(at(count_ - 1));
  for (std::size_t k = count_; k-- > first();) fit.add(at(k));
  return fit.result();
}

StraightFit PositionHistory::fit_newest(std::size_t fewest) const noexcept {
  if (count_ == 0) return {};
  StraightFit best;
  Fit fit(at(count_ - 1));
  for (std::size_t k = count_; k-- > first();) {
    fit.add(at(k));
    const StraightFit walk = fit.result();
    if (walk.positions >= fewest && walk.sigmas > best.sigmas) best = walk;
  }
  return best;
}

bool steady(const Target& e, const StraightFit& fit) noexcept {
  const LeastWalk least = least_walk(e, fit);
  return fit.sigmas > least.sigmas && fit.length_m > std::max(least.length_m, kGrew * fit.width_change_m);
}

double least_steady_m(const Target& e, const StraightFit& fit) noexcept { return least_walk(e, fit).length_m; }

bool keeps_its_width(const StraightFit& fit, double change_m) noexcept { return change_m < kRigidShare * fit.length_m; }

bool rigid(const Target& e, const StraightFit& fit) noexcept {
  const bool both_sides = e.appearance.whole && fit.whole_positions >= kFewestWhole;
  return both_sides && e.appearance.solid() && steady(e, fit) && keeps_its_width(fit, fit.width_change_m);
}

}  // namespace jaywalk
