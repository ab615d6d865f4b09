#include "planner/perception/recent_path.h"

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
double noise_variance(double left_m2, std::size_t n) {
  return (left_m2 + kNoiseWeighs * kNoiseM * kNoiseM) / (2.0 * static_cast<double>(n) - 4.0 + kNoiseWeighs);
}

}  // namespace

void RecentPath::add(Time when, Vec2 where, double width, bool whole) noexcept {
  if (count_ > 0 && when - at(count_ - 1).since < kApart) {
    Place& newest = places_[(count_ - 1) % kPlaces];
    newest.seen += 1;
    newest.when += (when - newest.when) / newest.seen;
    newest.where = newest.where + (where - newest.where) * (1.0 / newest.seen);
    newest.width_m = width;
    newest.whole = whole;
    return;
  }
  places_[count_ % kPlaces] = {when, when, where, width, whole, 1};
  ++count_;
}

std::size_t RecentPath::first() const noexcept {
  std::size_t k = count_ - std::min(count_, kPlaces);
  while (k + 1 < count_ && at(count_ - 1).when - at(k).when > kRemembers) ++k;
  return k;
}

double RecentPath::hop(std::size_t k) const noexcept {
  const double walked_s = std::min(to_seconds(at(k).when - at(k - 1).when), kLongestStepS);
  return distance(at(k - 1).where, at(k).where) - kWalkMps * walked_s;
}

void RecentPath::note_widths(std::size_t begin, StraightWalk& walk) const noexcept {
  double widest = 0.0, narrowest = std::numeric_limits<double>::infinity();
  for (std::size_t k = begin; k < count_; ++k) {
    const double width = at(k).width_m;
    walk.widest_m = std::max(walk.widest_m, width);
    if (at(k).whole) widest = std::max(widest, width), narrowest = std::min(narrowest, width);
  }
  walk.width_change_m = std::max(0.0, widest - narrowest);
}

StraightWalk RecentPath::fit() const noexcept {
  const std::size_t begin = first(), n = count_ - begin;
  StraightWalk walk;
  walk.places = n;
  if (n < 3) return walk;
  const Time newest = at(count_ - 1).when;
  const auto seconds = [&](std::size_t k) { return to_seconds(at(k).when - newest); };
  double mean_t = 0.0;
  Vec2 mean;
  for (std::size_t k = begin; k < count_; ++k) {
    mean_t += seconds(k) / static_cast<double>(n);
    mean = mean + at(k).where * (1.0 / static_cast<double>(n));
    if (k > begin) walk.longest_hop_m = std::max(walk.longest_hop_m, hop(k));
  }
  double tt = 0.0, scatter = 0.0;
  Vec2 tp;
  for (std::size_t k = begin; k < count_; ++k) {
    const double t = seconds(k) - mean_t;
    const Vec2 p = at(k).where - mean;
    tt += t * t;
    tp = tp + p * t;
    scatter += dot(p, p);
  }
  if (!(tt > 0.0) || scatter < kRoundOffM2) return walk;
  const Vec2 velocity = tp * (1.0 / tt);
  walk.duration_s = -seconds(begin);
  walk.length_m = norm(velocity) * walk.duration_s;
  const double explained = dot(velocity, tp);
  walk.explained = explained / scatter;
  walk.sigmas = norm(velocity) * std::sqrt(tt / noise_variance(std::max(scatter - explained, 0.0), n));
  note_widths(begin, walk);
  return walk;
}

}  // namespace jaywalk
