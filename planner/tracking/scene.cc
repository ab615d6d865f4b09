#include "planner/tracking/scene.h"

#include <algorithm>
#include <cmath>

#include "planner/tracking/target.h"
#include "planner/tracking/tuning.h"

namespace jaywalk {
namespace {
constexpr double kTurnRad = 0.1;
constexpr double kBodyM = 0.5;  // about a turn's middle: a pedestrian there is no wider, shoulders and all
constexpr double kOwnM = 0.3;   // about the axle's: nobody stands there, so that near it everything is asked
constexpr float kFarthestPartM = 1.0F;
constexpr float kSameM = 0.03F;   // a laser's noise at this distance, twice
constexpr double kSwaysM = 0.05;  // a mast, and the noise
constexpr int kMost = 20;         // headings remembered: what was taken off is forgotten after as many

/// The middle of the turn that takes the robot from one pose to the other, in its own frame at both.
Vec2 middle_of_turn(const Pose2& from, const Pose2& to) {
  const Pose2 step = inverse(from) * to;
  // c = step c: c = (I - R)^-1 t, and (I - R)^-1 = (1, -cot(w/2); cot(w/2), 1) / 2 for a turn by w.
  const Vec2 half = direction(0.5 * step.heading);
  const double cot = half.x / half.y;
  return {0.5 * (step.x - cot * step.y), 0.5 * (step.y + cot * step.x)};
}

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

bool SelfMask::on_robot(std::size_t beam, double range_m) const noexcept {
  return agreed_[beam] >= kEnough && std::fabs(range_m - static_cast<double>(range_m_[beam])) < kSwaysM;
}

void SelfMask::learn(const LaserScan& scan, const Pose2& map_from_robot) noexcept {
  const std::size_t beams = std::min<std::size_t>(scan.beam_count, kMaxBeams);
  for (std::size_t b = 0; b < beams; ++b) measured_[b] = measured_[b] || scan.is_hit(b) || scan.found_nothing(b);
  const auto as_then = [&](const Pose2& asked) {
    return std::fabs(wrap_angle(map_from_robot.heading - asked.heading)) < kTurnRad;
  };
  if (std::any_of(asked_at_.begin(), asked_at_.end(), as_then)) return;
  const Vec2 middle = middle_of_turn(asked_at_[last_asked_], map_from_robot);
  last_asked_ = (last_asked_ + 1) % asked_at_.size();
  asked_at_[last_asked_] = map_from_robot;
  asked_ = std::min(asked_ + 1, std::uint32_t{kEnough});
  const bool on_the_spot = norm(middle) < kOwnM;
  const Transform2 robot_from_laser(robot_from_laser_);
  for (std::size_t b = 0; b < beams; ++b) {
    if (!scan.is_hit(b)) continue;  // proves nothing
    const float range = scan.range_m[b];
    const Vec2 there = robot_from_laser * (direction(scan.angle_rad(b)) * static_cast<double>(range));
    if (!on_the_spot && distance(there, middle) < kBodyM) continue;
    const bool same = range < kFarthestPartM && std::fabs(range - range_m_[b]) < kSameM;
    if (same) {
      agreed_[b] = static_cast<std::uint8_t>(std::min(agreed_[b] + 1, kMost));
    } else if (agreed_[b] > 0) {
      --agreed_[b];  // a mast sways; the robot does not lose it
    } else {
      range_m_[b] = range;
    }
  }
}

void Scene::update(const LaserScan& scan, const Pose2& map_from_robot, const Twist2& twist, const EvidenceMap& still,
                   const Targets& targets) noexcept {
  self_mask_.learn(scan, map_from_robot);
  projection_.project(scan, robot_from_laser, twist, points);
  sweep = sweep_of(scan);
  drop_own_points(scan);
  project_empty_beams(scan, twist);
  begin_at_a_jump(sweep, points);
  map_from_laser = map_from_robot * robot_from_laser;
  const Transform2 to_map(map_from_robot);
  for (std::size_t k = 0; k < points.size(); ++k) {
    in_map.position[k] = to_map * points[k].in_robot;
    in_map.ground[k] = ground_at(still, in_map.position[k], points[k].range_m);
  }
  cut_at_jumps(points, sweep, segments);
  split_detections(targets, in_map, segments);
  find_detections(*this, map_from_laser.position(), detections);
}

bool Scene::ends_on_robot(const LaserScan& scan, std::uint32_t beam) const noexcept {
  if (beam >= scan.beam_count || beam >= kMaxBeams) return false;
  if (self_mask_.blocked(beam) || scan.too_near(beam)) return true;
  if (!scan.is_hit(beam)) return false;
  const auto range_m = static_cast<double>(scan.range_m[beam]);
  return range_m < kNearestSeenM || self_mask_.on_robot(beam, range_m);
}

/// A target half behind a mast is told so.
void Scene::drop_own_points(const LaserScan& scan) noexcept {
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
  projection_.project_empty(scan, robot_from_laser, twist, range_m, empty);
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
