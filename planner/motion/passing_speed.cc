#include "planner/motion/passing_speed.h"

#include <algorithm>

#include "planner/motion/pursuit.h"
#include "planner/motion/twist_ramp.h"

namespace jaywalk {
namespace {

// Somebody who sets out goes 0.4 m or so within a second: known to walk after half of it, braked for by the end.
constexpr double kGapTakes_s = 1.0;
constexpr double kLeast_mps = 0.2;    // braked to nothing within 2 to 4 cm; slower, a robot would never get by
constexpr double kStopped_mps = 0.1;  // as who walks is too slow to be called so (perception/motion_judgement.cc)

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

}  // namespace

double passing_speed(const Path& path, Vec2 robot_in_map, std::span<const Stander> standing,
                     std::span<const Track> tracks, const SpeedChoiceConfig& config) noexcept {
  if (path.empty()) return config.max_speed_mps;
  double most = at(robot_in_map, standing, tracks, config);
  for (std::size_t k = nearest_point(path, robot_in_map); k < path.size(); ++k) {
    const double ahead_m = distance(robot_in_map, path[k]);  // or farther, along the path
    if (slowing_speed(0.0, ahead_m, config.max_accel_mps2) >= most) break;
    most = std::min(most, slowing_speed(at(path[k], standing, tracks, config), ahead_m, config.max_accel_mps2));
  }
  return most;
}

}  // namespace jaywalk
