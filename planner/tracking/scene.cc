#include "planner/tracking/scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "planner/tracking/association.h"
#include "planner/tracking/detection.h"
#include "planner/tracking/tuning.h"

namespace jaywalk {
namespace {

/// Range of a beam without a return within which cells count as observed: a trajectory of 6 s at 0.6 m/s, rounded up.
constexpr double kObservedM = 4.0;

Becomes entry_of(const Targets& targets, const Detection& detection, Time now) {
  const auto target = std::find_if(targets.begin(), targets.end(),
                                   [&](const Target& b) { return b.estimate.track.id == detection.track_id; });
  if (target == targets.end()) return Becomes::kWall;
  if (target->estimate.track.moving || (detection.in_free_space && target->confirmed() && !target->existence.settled))
    return Becomes::kNothing;
  const bool may_walk_on = !detection.on_wall && target->appearance.whole && target->appearance.solid() &&
                           now - target->existence.born < kMayGoOnWithin;
  return may_walk_on ? Becomes::kObstacle : Becomes::kWall;
}

/// Nor do points near a moving target, where nothing stands: not all of a swinging leg's are the detection's.
void leave_out_movers(const Targets& targets, std::span<const Vec2> points_in_map, const EvidenceMap& still,
                      Entries& out) {
  for (const Target& target : targets) {
    if (!target.estimate.track.moving) continue;
    const Vec2 middle = target.estimate.track.position_in_map;
    const double reach = target.estimate.track.radius_m + kSkinM;
    for (std::size_t k = 0; k < points_in_map.size(); ++k) {
      const Vec2 p = points_in_map[k];
      if (!(std::fabs(p.x - middle.x) < reach && distance(p, middle) < reach)) continue;  // most end at the first
      if (!still.occupied(still.cell_at(p))) out[k] = Becomes::kNothing;
    }
  }
}

}  // namespace

void Scene::update(const LaserScan& scan, const Pose2& map_from_robot, const Twist2& twist, const EvidenceMap& still,
                   const Targets& targets) noexcept {
  self_mask_.learn(scan, map_from_robot);
  projection_.project(scan, robot_from_laser_, twist, points);
  const Sweep sweep = sweep_of(scan);
  drop_own_points(scan, sweep);
  project_empty_beams(scan, twist);
  begin_at_a_jump(sweep, points);
  map_from_laser = map_from_robot * robot_from_laser_;
  const Transform2 to_map(map_from_robot);
  for (std::size_t k = 0; k < points.size(); ++k) {
    in_map.position[k] = to_map * points[k].in_robot;
    in_map.ground[k] = ground_at(still, in_map.position[k], points[k].range_m);
  }
  cut_at_jumps(points, sweep, segments_);
  split_detections(targets, in_map, segments_);
  find_detections(points, in_map, segments_, sweep, map_from_laser.position(), detections);
}

bool Scene::ends_on_robot(const LaserScan& scan, std::uint32_t beam) const noexcept {
  if (beam >= scan.beam_count || beam >= kMaxBeams) return false;
  if (self_mask_.blocked(beam) || scan.too_near(beam)) return true;
  if (!scan.is_hit(beam)) return false;
  const auto range_m = static_cast<double>(scan.range_m[beam]);
  return range_m < kNearestSeenM || self_mask_.on_robot(beam, range_m);
}

/// A target half behind a mast is told so.
void Scene::drop_own_points(const LaserScan& scan, const Sweep& sweep) noexcept {
  std::size_t kept = 0;
  for (ScanPoint point : points) {
    if (ends_on_robot(scan, point.beam)) continue;
    point.after_own = ends_on_robot(scan, sweep.before(point.beam));
    point.before_own = ends_on_robot(scan, sweep.after(point.beam));
    points[kept++] = point;
  }
  points.truncate(kept);
}

void Scene::project_empty_beams(const LaserScan& scan, const Twist2& twist) noexcept {
  const double range_m = std::min(kObservedM, kSeesAll * static_cast<double>(scan.range_max_m));
  projection_.project_empty(scan, robot_from_laser_, twist, range_m, empty);
  std::size_t kept = 0;
  for (const ScanPoint& end : empty) {
    if (!ends_on_robot(scan, end.beam)) empty[kept++] = end;
  }
  empty.truncate(kept);
}

void decide_entries(const Targets& targets, const Detections& detections, std::span<const Vec2> points_in_map,
                    const EvidenceMap& still, Time now, Entries& out) noexcept {
  std::fill_n(out.begin(), points_in_map.size(), Becomes::kWall);
  for (const Detection& c : detections) {
    const Becomes entry = entry_of(targets, c, now);
    for (std::uint32_t k = c.segment.first; k <= c.segment.last; ++k) out[k] = entry;
  }
  leave_out_movers(targets, points_in_map, still, out);
}

}  // namespace jaywalk
