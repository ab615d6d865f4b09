#include "planner/perception/recent_path.h"

#include <algorithm>

namespace jaywalk {
namespace {

constexpr double kRoundOffM2 = 1e-12;  // scatter of places that are all the same, a micrometre's square

}  // namespace

void RecentPath::add(Time when, Vec2 where) noexcept {
  places_[count_ % kRemembered] = {when, where};
  ++count_;
}

StraightWalk RecentPath::fit() const noexcept {
  const std::size_t n = std::min(count_, kRemembered);
  if (n < 3) return {.places = n};
  const Place& newest = places_[(count_ - 1) % kRemembered];
  const Place& oldest = places_[(count_ - n) % kRemembered];
  double mean_t = 0.0;
  Vec2 mean;
  for (std::size_t k = 0; k < n; ++k) {
    mean_t += to_seconds(places_[k].when - newest.when) / static_cast<double>(n);
    mean = mean + places_[k].where * (1.0 / static_cast<double>(n));
  }
  double tt = 0.0, scatter = 0.0;
  Vec2 tp;
  for (std::size_t k = 0; k < n; ++k) {
    const double t = to_seconds(places_[k].when - newest.when) - mean_t;
    const Vec2 p = places_[k].where - mean;
    tt += t * t;
    tp = tp + p * t;
    scatter += dot(p, p);
  }
  if (!(tt > 0.0) || scatter < kRoundOffM2) return {.places = n};
  const Vec2 velocity = tp * (1.0 / tt);
  const double duration = to_seconds(newest.when - oldest.when);
  return {.places = n,
          .length_m = norm(velocity) * duration,
          .duration_s = duration,
          .explained = dot(velocity, tp) / scatter};
}

}  // namespace jaywalk
