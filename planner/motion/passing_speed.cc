#include "planner/motion/passing_speed.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

// Somebody who sets out goes 0.4 m or so within a second: known to walk after half of it, braked for by the end.
constexpr double kGapTakes_s = 1.0;
constexpr double kLeast_mps = 0.2;  // braked to nothing within 2 to 4 cm; slower, a robot would never get by
constexpr double kStopped_mps = 0.1;

/// The most at `ahead_m` of here that lets the robot be slow enough there, with half the comfortable braking: the
/// other half is the jerk's share.
double before(double there_mps, double ahead_m, const SpeedChoiceConfig& config) {
  return std::sqrt(there_mps * there_mps + config.max_accel_mps2 * ahead_m);
}

double beside(double gap_m) { return std::max(gap_m / kGapTakes_s, kLeast_mps); }

/// The most with the robot there.
double at(Vec2 robot, std::span<const Stander> standing, std::span<const Track> tracks,
          const SpeedChoiceConfig& config) {
  double most = config.max_speed_mps;
  const auto pass = [&](Vec2 him, double radius_m) {
    most = std::min(most, beside(distance(robot, him) - config.robot_radius_m - radius_m));
  };
  for (const Stander& stander : standing) pass(stander.position_in_map, stander.radius_m);
  for (const Track& track : tracks) {
    if (track.moving && norm(track.velocity_in_map) < kStopped_mps) pass(track.position_in_map, track.radius_m);
  }
  return most;
}

std::size_t nearest_point(const Path& path, Vec2 robot) {
  const auto nearer = [&](Vec2 a, Vec2 b) { return distance(a, robot) < distance(b, robot); };
  return static_cast<std::size_t>(std::min_element(path.begin(), path.end(), nearer) - path.begin());
}

}  // namespace

double passing_speed(const Path& path, Vec2 robot_in_map, std::span<const Stander> standing,
                     std::span<const Track> tracks, const SpeedChoiceConfig& config) noexcept {
  if (path.empty()) return config.max_speed_mps;
  double most = at(robot_in_map, standing, tracks, config);
  for (std::size_t k = nearest_point(path, robot_in_map); k < path.size(); ++k) {
    const double ahead_m = distance(robot_in_map, path[k]);  // or farther, along the path
    if (before(0.0, ahead_m, config) >= most) break;
    most = std::min(most, before(at(path[k], standing, tracks, config), ahead_m, config));
  }
  return most;
}

}  // namespace jaywalk
