#include "planner/motion/passing_speed.h"

#include <algorithm>

#include "planner/motion/pursuit.h"
#include "planner/motion/twist_ramp.h"
#include "planner/tracking/tuning.h"

namespace jaywalk {
namespace {

// A pedestrian that sets out goes 0.4 m or so within a second: known to walk after half of it, braked for by the end.
constexpr double kGapTakes_s = 1.0;
constexpr double kLeast_mps = 0.2;  // braked to nothing within 2 to 4 cm; slower, a robot would never get by

double beside(double gap_m) { return std::max(gap_m / kGapTakes_s, kLeast_mps); }

/// The most beside standing pedestrians, by the gap that `gap` has to a place.
template <typename Gap>
double most_beside(std::span<const StandingPedestrian> standing, std::span<const Track> tracks,
                   const SpeedChoiceConfig& config, const Gap& gap) {
  double most = config.max_speed_mps;
  for (const StandingPedestrian& stander : standing)
    most = std::min(most, beside(gap(stander.position_in_map) - stander.radius_m));
  for (const Track& track : tracks) {
    if (track.moving && norm(track.velocity_in_map) < kStoppedMps)
      most = std::min(most, beside(gap(track.position_in_map) - track.radius_m));
  }
  return most;
}

}  // namespace

double passing_speed(const Way& way, const Pose2& map_from_robot, std::span<const StandingPedestrian> standing,
                     std::span<const Track> tracks, const SpeedChoiceConfig& config) noexcept {
  const Path& path = way.places;
  if (path.empty()) return config.max_speed_mps;
  const auto at = [&](Vec2 place, Vec2 ahead) {
    return most_beside(standing, tracks, config, [&](Vec2 him) { return config.robot.distance_to(him, place, ahead); });
  };
  const Vec2 here = map_from_robot.position();
  double most = at(here, direction(map_from_robot.heading));
  for (std::size_t k = nearest_point(path, here); k < path.size(); ++k) {
    const double ahead_m = distance(here, path[k]);  // or farther, along the path
    if (slowing_speed(0.0, ahead_m, config.max_accel_mps2) >= most) break;
    const double there = at(path[k], way.looking_at(k, ahead_m, map_from_robot));
    most = std::min(most, slowing_speed(there, ahead_m, config.max_accel_mps2));
  }
  return most;
}

}  // namespace jaywalk
