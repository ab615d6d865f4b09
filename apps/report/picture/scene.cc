#include "apps/report/picture/scene.h"

#include <cmath>

#include "hal/types/trig.h"

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

constexpr double kMarginM = 0.6;
constexpr double kStrayShare = 0.005;  ///< hits through windows and doors that would shrink everything else

/// The values that all but a share of kStrayShare lie between.
std::pair<double, double> bulk(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto stray = static_cast<std::size_t>(kStrayShare * static_cast<double>(values.size()));
  return {values[stray], values[values.size() - 1 - stray]};
}

void hold_bulk(Extent& box, const std::vector<Vec2>& points) {
  if (points.empty()) return;
  std::vector<double> x, y;
  for (const Vec2 p : points) x.push_back(p.x), y.push_back(p.y);
  const auto [left, right] = bulk(std::move(x));
  const auto [bottom, top] = bulk(std::move(y));
  box.hold({left, bottom});
  box.hold({right, top});
}

/// How much is expected near the robot: each counts 1 where the robot stands, half 2 m away.
double busyness(const Plan& plan, Vec2 robot) {
  double busy = 0.0;
  for (const Prediction& p : plan.predictions) {
    const double away = distance(p.position_in_map, robot) / 2.0;
    busy += 1.0 / (1.0 + away * away);
  }
  return busy;
}

/// A beam that knows nothing ends where the one before it did.
std::vector<Vec2> shown_beams(const LaserScan& scan) {
  std::vector<Vec2> ends;
  double range_m = 0.0;
  for (std::size_t k = 0; k < kShownBeams && scan.beam_count >= kShownBeams; ++k) {
    const std::size_t beam = k * (scan.beam_count - 1) / (kShownBeams - 1);
    if (scan.state(beam) != BeamState::kUnknown)
      range_m = static_cast<double>(std::min(scan.range_m[beam], scan.range_max_m));
    ends.push_back(direction(scan.angle_rad(beam)) * range_m);
  }
  return ends;
}

constexpr double kStepS = 0.4;       ///< 0.24 m at 0.6 m/s: what a straight line between two positions hides
constexpr double kGoneAfterS = 1.0;  ///< a body without a point for this long has left

/// Between those of `all` round time `t`, which it gives with the share of the way from one to the other; the first
/// before it, the last after it.
template <class Timed, class Between>
auto held(const std::vector<Timed>& all, Time t, const Between& between) {
  const auto later = std::upper_bound(all.begin(), all.end(), t, [](Time a, const Timed& b) { return a < b.t; });
  const Timed& from = later == all.begin() ? all.front() : later[-1];
  const Timed& to = later == all.end() ? all.back() : *later;
  return between(from, to, from.t == to.t ? 0.0 : to_seconds(t - from.t) / to_seconds(to.t - from.t));
}

Vec2 held_position(const Trail& trail, Time t) {
  return held(trail.points, t, [](const TrailPoint& from, const TrailPoint& to, double share) {
    return from.position + (to.position - from.position) * share;
  });
}

Pose2 held_pose(const std::vector<DrivenPose>& driven, Time t) {
  return held(driven, t, [](const DrivenPose& from, const DrivenPose& to, double share) {
    const Vec2 at = from.pose.position() + (to.pose.position() - from.pose.position()) * share;
    return Pose2{at.x, at.y, from.pose.heading + wrap_angle(to.pose.heading - from.pose.heading) * share};
  });
}

Time gone_at(const Trail& trail) { return trail.points.back().t + duration_from_seconds(kGoneAfterS); }

}  // namespace

void DrivenWay::add(Time t, const Pose2& pose, const LaserScan& scan) {
  if (!poses_.empty() && t - poses_.back().t < spacing_) return;
  poses_.push_back({t, pose, shown_beams(scan)});
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

std::vector<Vec2> occupied_cells(const EvidenceMap& map, const std::vector<DrivenPose>& driven, double reach_m) {
  std::vector<Vec2> cells;
  Extent box;
  for (const DrivenPose& d : driven) box.hold(d.pose.position());
  if (box.empty()) return cells;
  const CellIndex low = map.cell_at(box.low - Vec2{reach_m, reach_m});
  const CellIndex high = map.cell_at(box.high + Vec2{reach_m, reach_m});
  for (std::int32_t j = low.j; j <= high.j; ++j) {
    for (std::int32_t i = low.i; i <= high.i; ++i) {
      if (map.occupied({i, j})) cells.push_back(map.centre_of({i, j}));
    }
  }
  return cells;
}

Extent extent_of(const PictureScene& scene) {
  Extent box;
  for (const sim::WallSegment& wall : scene.walls) box.hold(wall.from), box.hold(wall.to);
  for (const DrivenPose& d : scene.driven) box.hold(d.pose.position());
  if (scene.walls.empty()) hold_bulk(box, scene.occupied);
  if (scene.start) box.hold(scene.start->position());
  if (scene.goal) box.hold(*scene.goal);
  if (box.empty()) box.hold({0.0, 0.0});
  const Vec2 margin{kMarginM, kMarginM};
  return {box.low - margin, box.high + margin};
}

FieldRaster raster_of(const FieldView& view) {
  return {{view.low.i * view.cell_m, view.low.j * view.cell_m},
          view.width,
          view.height,
          view.cell_m,
          {view.psi.begin(), view.psi.end()},
          view.of};
}

void BusiestMoment::consider(const Plan& plan, const Planner& planner, std::span<const Track> tracks,
                             const Pose2& map_from_robot) {
  if (plan.status != PlanStatus::kOk) return;
  const double busy = busyness(plan, map_from_robot.position());
  longest_path_ = std::max(longest_path_, plan.path.size());
  const bool half_way = busy == busiest_ && 2 * plan.path.size() >= longest_path_;
  if (busy <= busiest_ && !half_way) return;
  busiest_ = busy;
  moment_ = PlanMoment{plan.stamp,
                       map_from_robot,
                       {tracks.begin(), tracks.end()},
                       {plan.predictions.begin(), plan.predictions.end()},
                       {plan.path.begin(), plan.path.end()},
                       raster_of(planner.view_field())};
}

Playback::Playback(const std::vector<DrivenPose>& driven, std::size_t most_steps) : driven_(driven) {
  if (driven_.empty()) return;
  begin_ = driven_.front().t;
  lasts_s_ = std::max(to_seconds(driven_.back().t - begin_), kStepS);
  const auto wanted = static_cast<std::size_t>(std::ceil(lasts_s_ / kStepS)) + 1;
  steps_ = std::max<std::size_t>(2, std::min(wanted, most_steps));
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

std::vector<DrivenPose> Playback::scans(std::size_t count) const {
  std::vector<DrivenPose> all;
  auto newest = std::ranges::find_if(driven_, [](const DrivenPose& driven) { return !driven.seen.empty(); });
  for (std::size_t k = 0; k < count && newest != driven_.end(); ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(count - 1);
    const Time t = begin_ + duration_from_seconds(lasts_s_ * share);
    for (auto next = newest; next != driven_.end() && next->t <= t; ++next)
      if (!next->seen.empty()) newest = next;
    all.push_back(*newest);
  }
  return all;
}

std::vector<Vec2> Playback::positions(const Trail& trail) const {
  std::vector<Vec2> all;
  for (std::size_t step = 0; step < steps_; ++step) all.push_back(held_position(trail, time_of(step)));
  return all;
}

std::pair<double, double> Playback::stay(const Trail& trail) const {
  const auto share = [&](Time t) { return std::clamp(to_seconds(t - begin_) / lasts_s_, 0.0, 1.0); };
  return {share(trail.points.front().t), share(gone_at(trail))};
}

std::optional<Vec2> position_at(const Trail& trail, Time t) {
  if (trail.points.empty() || t < trail.points.front().t || t > gone_at(trail)) return std::nullopt;
  return held_position(trail, t);
}

}  // namespace jaywalk
