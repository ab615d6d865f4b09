#include "apps/report/trails.h"

#include <algorithm>

namespace jaywalk {
namespace {

/// Keeps of what stands in the order of time the first, and what comes `spacing` or more after the last that was kept.
template <class Timed>
void keep_every(Duration spacing, std::vector<Timed>& all) {
  Time kept = kNever;
  std::erase_if(all, [&](const Timed& one) {
    if (age(kept, one.t) < spacing) return true;
    kept = one.t;
    return false;
  });
}

}  // namespace

void DrivenWay::add(Time t, const Pose2& pose) {
  if (!poses_.empty() && t - poses_.back().t < spacing_) return;
  poses_.push_back({t, pose});
  if (poses_.size() > kMostPoses) keep_every(spacing_ *= 2, poses_);
}

void TrailBook::add(std::uint32_t id, Time t, Vec2 position, double radius_m, bool flag) {
  Trail& trail = trails_[id];
  trail.id = id;
  trail.radius_m = radius_m;
  trail.flagged = trail.flagged || flag;
  if (!trail.points.empty() && t - trail.points.back().t < spacing_) return;
  trail.points.push_back({t, position});
  if (++points_ > kMostPoints) thin_out();
  if (trails_.size() > kMostTrails) forget_oldest();
}

void TrailBook::thin_out() {
  spacing_ *= 2;
  points_ = 0;
  for (auto& [id, trail] : trails_) {
    keep_every(spacing_, trail.points);
    trail.points.shrink_to_fit();
    points_ += trail.points.size();
  }
}

void TrailBook::forget_oldest() {
  std::vector<Time> ends;
  for (const auto& [id, trail] : trails_) ends.push_back(trail.points.back().t);
  const auto middle = ends.begin() + static_cast<std::ptrdiff_t>(ends.size() / 2);
  std::nth_element(ends.begin(), middle, ends.end());
  std::erase_if(trails_, [&](const auto& one) {
    if (one.second.points.back().t >= *middle) return false;
    points_ -= one.second.points.size();
    return true;
  });
}

std::vector<Trail> TrailBook::trails() const {
  std::vector<Trail> all;
  all.reserve(trails_.size());
  for (const auto& [id, trail] : trails_) all.push_back(trail);
  return all;
}

}  // namespace jaywalk
