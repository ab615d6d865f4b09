#include "planner/tracking/recent_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace jaywalk {
namespace {

constexpr double kWalkMps = 1.5;
constexpr double kLongestStepS = 0.13;                // what was unseen for longer may be another
constexpr double kNoiseM = 0.01, kNoiseWeighs = 4.0;  // of a place an axis, as if known from so many
constexpr double kRoundOffM2 = 1e-12;                 // scatter of places that are all the same, a micrometre's square

/// Of `n` places an axis, from what a walk leaves of their scatter: 2 n numbers, of which 4 went into the walk.
double noise_variance(double left_m2, double n) {
  return (left_m2 + kNoiseWeighs * kNoiseM * kNoiseM) / (2.0 * n - 4.0 + kNoiseWeighs);
}

}  // namespace

/// Takes places from the newest on backwards, and fits a walk to those that it has.
class RecentPath::Fit {
 public:
  explicit Fit(const Place& newest) : newest_(newest), last_(newest) {}
  void add(const Place& older) noexcept;
  [[nodiscard]] StraightWalk walk() const noexcept;

 private:
  /// How much farther it is from the place before to `place` than a walker comes in the time.
  [[nodiscard]] static double hop(const Place& before, const Place& place) noexcept;

  Place newest_, last_;  ///< last added: the oldest
  StraightWalk walk_;    ///< what needs no fit
  double narrowest_m_ = std::numeric_limits<double>::infinity(), widest_whole_m_ = 0.0;
  double n_ = 0.0, t_ = 0.0, tt_ = 0.0, pp_ = 0.0;  ///< sums; times and places less the newest
  Vec2 p_, tp_;
};

double RecentPath::Fit::hop(const Place& before, const Place& place) noexcept {
  const double walked_s = std::min(to_seconds(place.when - before.when), kLongestStepS);
  return distance(before.seen.where_in_map, place.seen.where_in_map) - kWalkMps * walked_s;
}

void RecentPath::Fit::add(const Place& place) noexcept {
  const double t = to_seconds(place.when - newest_.when);
  const Vec2 p = place.seen.where_in_map - newest_.seen.where_in_map;
  n_ += 1.0, t_ += t, tt_ += t * t, pp_ += dot(p, p);
  p_ = p_ + p, tp_ = tp_ + p * t;
  if (walk_.places > 0) walk_.longest_hop_m = std::max(walk_.longest_hop_m, hop(place, last_));
  walk_.places += 1;
  walk_.duration_s = -t;
  walk_.spacing_m = std::max(walk_.spacing_m, place.seen.spacing_m);
  if (place.seen.whole) {
    walk_.whole_places += 1;
    widest_whole_m_ = std::max(widest_whole_m_, place.seen.width_m);
    narrowest_m_ = std::min(narrowest_m_, place.seen.width_m);
  }
  last_ = place;
}

StraightWalk RecentPath::Fit::walk() const noexcept {
  StraightWalk walk = walk_;
  const double tt = tt_ - t_ * t_ / n_, scatter = pp_ - dot(p_, p_) / n_;
  if (walk.places < 3 || !(tt > 0.0) || scatter < kRoundOffM2) return walk;
  const Vec2 tp = tp_ - p_ * (t_ / n_), velocity = tp * (1.0 / tt);
  const double explained = dot(velocity, tp);
  walk.length_m = norm(velocity) * walk.duration_s;
  walk.explained = explained / scatter;
  walk.sigmas = norm(velocity) * std::sqrt(tt / noise_variance(std::max(scatter - explained, 0.0), n_));
  walk.width_change_m = std::max(0.0, widest_whole_m_ - narrowest_m_);
  return walk;
}

void RecentPath::add(Time when, const Sighting& seen) noexcept {
  if (count_ > 0 && when - at(count_ - 1).since < kApart) {
    Place& newest = places_[(count_ - 1) % kPlaces];
    const Vec2 before = newest.seen.where_in_map;
    newest.scans += 1;
    newest.when += (when - newest.when) / newest.scans;
    newest.seen = seen;
    newest.seen.where_in_map = before + (seen.where_in_map - before) * (1.0 / newest.scans);
    return;
  }
  places_[count_ % kPlaces] = {when, when, seen, 1};
  ++count_;
}

void RecentPath::move(Vec2 by_m) noexcept {
  for (Place& place : places_) place.seen.where_in_map = place.seen.where_in_map + by_m;
}

std::size_t RecentPath::first() const noexcept {
  std::size_t k = count_ - std::min(count_, kPlaces);
  while (k + 1 < count_ && at(count_ - 1).when - at(k).when > kRemembers) ++k;
  return k;
}

StraightWalk RecentPath::fit() const noexcept {
  if (count_ == 0) return {};
  Fit fit(at(count_ - 1));
  for (std::size_t k = count_; k-- > first();) fit.add(at(k));
  return fit.walk();
}

StraightWalk RecentPath::latest_walk(std::size_t fewest) const noexcept {
  if (count_ == 0) return {};
  StraightWalk best;
  Fit fit(at(count_ - 1));
  for (std::size_t k = count_; k-- > first();) {
    fit.add(at(k));
    const StraightWalk walk = fit.walk();
    if (walk.places >= fewest && walk.sigmas > best.sigmas) best = walk;
  }
  return best;
}

}  // namespace jaywalk
