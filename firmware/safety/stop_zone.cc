#include "firmware/safety/stop_zone.h"

#include <cmath>
#include <limits>

#include "firmware/safety/latency.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"
#include "hal/types/fixed_vector.h"

namespace jaywalk {
namespace {

using Rules = StopZoneRules<double>;
constexpr double kStep_m = SweptPath::kStep_m;

/// Where a beam ends, in the laser's frame.
Vec2 end_of(const LaserScan& scan, std::size_t beam) {
  return direction(scan.angle_rad(beam)) * static_cast<double>(scan.range_m[beam]);
}

/// The same of the surface that it meets: in the mean of its neighbours within 15 mm, which is less than a 70 mm post.
Vec2 surface_at(const LaserScan& scan, std::size_t beam) {
  constexpr double kHalf_m = 0.015, kDeep_m = 0.03;
  const auto range = [&](std::size_t k) { return static_cast<double>(scan.range_m[k]); };
  const double step_m = range(beam) * std::fabs(static_cast<double>(scan.angle_step_rad));
  const auto half = static_cast<std::size_t>(std::min(kHalf_m / std::max(step_m, 1e-4), 100.0));
  double sum = 0.0, count = 0.0;
  for (std::size_t k = beam - std::min(half, beam); k <= beam + half && k < scan.beam_count; ++k)
    if (scan.is_hit(k) && std::fabs(range(k) - range(beam)) < kDeep_m) sum += range(k), count += 1.0;
  return direction(scan.angle_rad(beam)) * (sum / count);
}

constexpr double kPost_m = 0.07;
constexpr const char* kRemedy = ", raise limits.brake_mps2 (what the drives are proved to do), or take ";

/// Fastest forward speed, m/s, from which the robot stops within `stop_m` metres while it turns at the model's rate.
double speed_for_stop(const RobotModel& model, Duration tick, double stop_m) {
  const double bt = model.limits.brake_mps2 * worst_reaction_s(model, tick);
  const double rim_mps = std::sqrt(bt * bt + 2.0 * model.limits.brake_mps2 * std::max(stop_m, 0.0)) - bt;
  return model.limits.max_speed_mps - (fastest_rim_mps(model) - rim_mps);
}

std::string lower_speed_to(double mps) {
  if (mps < 0.01) return "lower limits.max_speed_mps and max_turn_radps";
  return formatted("lower limits.max_speed_mps to %.2f", std::floor(100.0 * mps) / 100.0);
}

void require_in_reach(const RobotModel& model, const LaserModel& laser, Duration tick, const std::string& place) {
  const double stop_m = longest_stop_m(model, tick);
  double corner_m = 0.0;  // the farthest from the laser
  for (const Vec2 corner : corners_of(model.footprint))
    corner_m = std::max(corner_m, distance(laser.robot_from_laser.position(), corner));
  const double reach_m = stop_m + StopZoneConfig{}.margin_m + corner_m;
  const double step_rad = laser.fov_rad / (laser.beams - 1);
  const double seen_m = kPost_m / (2.0 * sin(std::min(0.5 * step_rad, 0.5 * kPi)));
  const auto refuse_beyond = [&](double limit_m, const char* why, const char* otherwise) {
    if (reach_m <= limit_m) return;
    throw StartupError(place + formatted(": stopping takes %.1f m, up to %.1f m from the laser, and %s %.1f m", stop_m,
                                         reach_m, why, limit_m),
                       lower_speed_to(speed_for_stop(model, tick, stop_m - (reach_m - limit_m))) + kRemedy + otherwise);
  };
  refuse_beyond(laser.range_max_m, "its range is", "a laser that sees farther");
  refuse_beyond(seen_m, "a post of 70 mm fits between two of its beams from", "a laser with more beams");
  refuse_beyond(SweptPath::kLongest_m, "the stop zone ends at", "a slower robot");
}

}  // namespace

StopZone::StopZone(const StopZoneConfig& config)
    : config_(config), rim_radius_m_(config.footprint.circumscribed_radius_m()) {}

double StopZone::margin_at(double rim_mps) const noexcept {
  const double share = std::min(rim_mps / Rules::kFull_mps, 1.0);
  return Rules::kCreepMargin_m + (config_.margin_m - Rules::kCreepMargin_m) * share;
}

double StopZone::speed_to_stop_within(double gap_m, double reaction_s) const noexcept {
  if (!(gap_m > 0.0)) return 0.0;
  const double bt = config_.brake_mps2 * reaction_s;
  return std::sqrt(bt * bt + 2.0 * config_.brake_mps2 * gap_m) - bt;
}

double StopZone::gap_m(const OfEach<LaserScan>& scans, const Twist2& twist,
                       std::span<const Vec2> unseen) const noexcept {
  const double rim_speed = rim_speed_mps(twist);
  double gap = std::numeric_limits<double>::infinity();
  if (rim_speed < 1e-9) return gap;
  const SweptPath path(twist, rim_speed, config_.look_ahead_m);
  const double margin = margin_at(rim_speed);
  const double reach_m = this->reach_m();
  const auto meet = [&](Vec2 point) {
    if (norm(point) <= reach_m) gap = std::min(gap, way_to(point, path, margin, std::min(gap, config_.look_ahead_m)));
  };
  for (const LaserScan& scan : scans) {
    const Transform2 robot_from_laser(mount_of(scan));
    for (std::size_t beam = 0; beam < scan.beam_count; ++beam)
      if (scan.is_hit(beam)) meet(robot_from_laser * end_of(scan, beam));
  }
  for (const Vec2 point : unseen) meet(point);
  return gap;
}

bool StopZone::may_creep(const OfEach<LaserScan>& scans, const Twist2& twist, std::span<const Vec2> unseen,
                         double reaction_s) const noexcept {
  const double look_m = stopping_distance_m(Rules::kCreep_mps, reaction_s) + kStep_m;
  FixedVector<Vec2, 2 * kMaxBeams> near;
  double nearest = Rules::kBeside_m;
  bool holds_all = true;
  const auto look = [&](Vec2 point) {
    const double away = config_.footprint.distance_to(point);
    if (away < Rules::kBeside_m + look_m) holds_all = near.push_back(point) && holds_all;
    nearest = std::min(nearest, away);
  };
  for (const Vec2 point : unseen) look(point);
  for (const LaserScan& scan : scans) {
    const Transform2 robot_from_laser(mount_of(scan));
    for (std::size_t beam = 0; beam < scan.beam_count; ++beam)
      if (scan.is_hit(beam)) look(robot_from_laser * surface_at(scan, beam));
  }
  if (nearest >= Rules::kBeside_m || !holds_all) return false;
  const SweptPath path(twist, rim_speed_mps(twist), look_m);
  const double margin =
      std::clamp(nearest - Rules::kSwing_m, std::min(nearest, Rules::kLeast_m), Rules::kCreepMargin_m);
  return std::all_of(near.begin(), near.end(),
                     [&](Vec2 point) { return std::isinf(way_to(point, path, margin, look_m)); });
}

bool StopZone::is_on_body(const LaserScan& scan, std::size_t beam) const noexcept {
  return scan.is_hit(beam) && config_.footprint.distance_to(mount_of(scan) * end_of(scan, beam)) == 0.0;
}

std::size_t StopZone::beams_on_body(const LaserScan& scan) const noexcept {
  std::size_t count = 0;
  for (std::size_t beam = 0; beam < scan.beam_count; ++beam) count += is_on_body(scan, beam) ? 1U : 0U;
  return count;
}

double StopZone::way_to(Vec2 point, const SweptPath& path, double margin_m, double most_m) const noexcept {
  // No part of the body goes farther than the rim: the clearance lasts for so many steps at least.
  const auto free_steps = [margin_m](double clearance) {
    return static_cast<std::size_t>(std::max(1.0, (clearance - margin_m) / kStep_m));
  };
  const double clearance_now = config_.footprint.distance_to(point);
  double before = clearance_now;
  const std::size_t steps = std::min(static_cast<std::size_t>(most_m / kStep_m) + 1, path.steps());
  for (std::size_t k = free_steps(before); k <= steps; k += free_steps(before)) {
    const double clearance = config_.footprint.distance_to(path.seen_from(k, point));
    const bool still_touching = clearance_now == 0.0 && clearance == 0.0;
    if (still_touching || (clearance < margin_m && clearance < clearance_now - 1e-4)) {
      // The margin is met within this step, where the clearance has fallen to it; at once where it had before.
      const double within = before > margin_m ? (before - margin_m) / (before - clearance) : 0.0;
      return (static_cast<double>(k - 1) + within) * kStep_m;
    }
    before = clearance;
  }
  return std::numeric_limits<double>::infinity();
}

double fastest_rim_mps(const RobotModel& model) noexcept {
  return model.limits.max_speed_mps + model.limits.max_turn_radps * model.footprint.circumscribed_radius_m();
}

double longest_stop_m(const RobotModel& model, Duration tick) noexcept {
  const double v = fastest_rim_mps(model);
  return v * worst_reaction_s(model, tick) + v * v / (2.0 * model.limits.brake_mps2);
}

OfOthers<Pose2> other_mounts(const RobotModel& model) noexcept {
  OfOthers<Pose2> mounts;
  for (const LaserModel& laser : model.other_lasers) (void)mounts.push_back(laser.robot_from_laser);
  return mounts;
}

StopZoneConfig stop_zone_for(const RobotModel& model, Duration tick) noexcept {
  return {.footprint = model.footprint,
          .robot_from_laser = model.laser.robot_from_laser,
          .brake_mps2 = model.limits.brake_mps2,
          .look_ahead_m = std::min(longest_stop_m(model, tick), SweptPath::kLongest_m),
          .robot_from_others = other_mounts(model)};
}

void require_zone_in_reach(const RobotModel& model, Duration tick, const std::string& place) {
  for (const LaserModel& laser : model.lasers()) require_in_reach(model, laser, tick, place);
}

}  // namespace jaywalk
