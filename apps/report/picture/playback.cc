#include "apps/report/picture/playback.h"

#include <algorithm>
#include <cmath>

#include "hal/types/trig.h"

namespace jaywalk {
namespace {
constexpr double kStepS = 0.4;       ///< 0.24 m at 0.6 m/s: what a straight line between two positions hides
constexpr double kGoneAfterS = 1.0;  ///< a body without a point for this long has left

/// The first of `all` later than `t`.
template <class Timed>
std::size_t after(const std::vector<Timed>& all, Time t) {
  const auto later = std::upper_bound(all.begin(), all.end(), t, [](Time a, const Timed& b) { return a < b.t; });
  return static_cast<std::size_t>(later - all.begin());
}

template <class Timed>
double share_between(const Timed& from, const Timed& to, Time t) {
  return to_seconds(t - from.t) / to_seconds(to.t - from.t);
}

Vec2 held_position(const Trail& trail, Time t) {
  const std::size_t next = after(trail.points, t);
  if (next == 0) return trail.points.front().position;
  if (next == trail.points.size()) return trail.points.back().position;
  const TrailPoint& from = trail.points[next - 1];
  const TrailPoint& to = trail.points[next];
  return from.position + (to.position - from.position) * share_between(from, to, t);
}

Pose2 held_pose(const std::vector<DrivenPose>& driven, Time t) {
  const std::size_t next = after(driven, t);
  if (next == 0) return driven.front().pose;
  if (next == driven.size()) return driven.back().pose;
  const Pose2& from = driven[next - 1].pose;
  const Pose2& to = driven[next].pose;
  const double share = share_between(driven[next - 1], driven[next], t);
  const Vec2 at = from.position() + (to.position() - from.position()) * share;
  return {at.x, at.y, from.heading + wrap_angle(to.heading - from.heading) * share};
}

Time gone_at(const Trail& trail) { return trail.points.back().t + duration_from_seconds(kGoneAfterS); }

}  // namespace

Playback::Playback(const std::vector<DrivenPose>& driven, std::size_t most_steps) : driven_(driven) {
  if (driven_.empty()) return;
  begin_ = driven_.front().t;
  lasts_s_ = std::max(to_seconds(driven_.back().t - begin_), kStepS);
  const auto wanted = static_cast<std::size_t>(std::ceil(lasts_s_ / kStepS)) + 1;
  steps_ = std::max<std::size_t>(2, std::min(wanted, most_steps));
}

Time Playback::time_of(std::size_t step) const {
  return begin_ + duration_from_seconds(lasts_s_ * static_cast<double>(step) / static_cast<double>(steps_ - 1));
}

std::vector<Pose2> Playback::robot() const {
  std::vector<Pose2> poses;
  for (std::size_t step = 0; step < steps_ && !driven_.empty(); ++step) {
    poses.push_back(held_pose(driven_, time_of(step)));
    if (step == 0) continue;
    const double before = poses[step - 1].heading;
    poses[step].heading = before + wrap_angle(poses[step].heading - before);
  }
  return poses;
}

std::vector<Vec2> Playback::positions(const Trail& trail) const {
  std::vector<Vec2> all;
  for (std::size_t step = 0; step < steps_; ++step) all.push_back(held_position(trail, time_of(step)));
  return all;
}

Playback::Stay Playback::stay(const Trail& trail) const {
  const auto share = [&](Time t) { return std::clamp(to_seconds(t - begin_) / lasts_s_, 0.0, 1.0); };
  return {share(trail.points.front().t), share(gone_at(trail))};
}

std::optional<Vec2> position_at(const Trail& trail, Time t) {
  if (trail.points.empty() || t < trail.points.front().t || t > gone_at(trail)) return std::nullopt;
  return held_position(trail, t);
}

}  // namespace jaywalk
