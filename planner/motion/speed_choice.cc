#include "planner/motion/speed_choice.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/motion/pursuit.h"

namespace jaywalk {
namespace {

constexpr double kStep_s = 0.2;  // 0.12 m of travel at 0.6 m/s: finer than a body

/// Walks along the path by arc length.
class PathWalker {
 public:
  PathWalker(const Path& path, Vec2 robot) : path_(path), at_(nearest_point(path, robot)), position_(path[at_]) {}
  Vec2 advance(double length_m) {
    while (at_ + 1 < path_.size()) {
      const double to_next = distance(position_, path_[at_ + 1]);
      if (to_next > length_m) {
        position_ = position_ + (path_[at_ + 1] - position_) * (length_m / to_next);
        return position_;
      }
      length_m -= to_next;
      position_ = path_[++at_];
    }
    return position_;
  }

 private:
  const Path& path_;
  std::size_t at_;
  Vec2 position_;
};

/// Whether it walks, or may well: faster than 0.15 m/s and than twice what its speed is uncertain by. The
/// tracker is slow to call a thing moving, since what it calls so changes the plan; here a false alarm costs a little
/// speed.
bool may_walk(const Track& track) {
  const double speed = norm(track.velocity_in_map);
  return track.moving || (speed > 0.15 && speed > 2.0 * std::sqrt(track.covariance.vv));
}

constexpr double kStopped_mps = 0.1;  // slower, he stands: passing_speed has him

bool meets_anyone(Vec2 robot, double after_s, std::span<const Track> tracks, const SpeedChoiceConfig& config) {
  for (const Track& track : tracks) {
    if (!may_walk(track) || (config.stands_at_worst && norm(track.velocity_in_map) < kStopped_mps)) continue;
    const Vec2 there = track.position_in_map + track.velocity_in_map * after_s;
    if (in_conflict(robot, there, track.velocity_in_map, track.radius_m, config.spread_mps * after_s, config)) {
      return true;
    }
  }
  return false;
}

/// Seconds until the first conflict when speeding up or slowing down to `speed`; the horizon when there is none.
double free_time(const Path& path, Vec2 robot, double speed_now, double speed, std::span<const Track> tracks,
                 const SpeedChoiceConfig& config) {
  PathWalker walker(path, robot);
  double v = speed_now;
  const int steps = static_cast<int>(config.horizon_s / kStep_s);
  for (int k = 1; k <= steps; ++k) {
    const double t = k * kStep_s;
    v += std::clamp(speed - v, -config.max_accel_mps2 * kStep_s, config.max_accel_mps2 * kStep_s);
    if (meets_anyone(walker.advance(v * kStep_s), t, tracks, config)) return t;
  }
  return config.horizon_s;
}

}  // namespace

bool in_conflict(Vec2 robot, Vec2 mover, Vec2 mover_velocity, double mover_radius_m, double spread_m,
                 const SpeedChoiceConfig& config) noexcept {
  const Vec2 to_robot = robot - mover;
  const double between = norm(to_robot) - config.robot_radius_m - mover_radius_m - spread_m;
  if (between < config.body_margin_m) return true;
  if (between > config.zone_ahead_m) return false;
  // The zone is a sector of +-45 degrees; the robot's disc reaches into it from the side as well: the distance of its
  // centre from the sector's edge, a line at 45 degrees, must exceed its radius.
  const double speed = norm(mover_velocity);
  if (speed < 1e-6) return false;
  const double ahead = dot(mover_velocity, to_robot) / speed;
  const double aside = std::fabs(cross(mover_velocity, to_robot)) / speed;
  return (aside - ahead) * 0.70710678118654752 < config.robot_radius_m + spread_m;
}

double choose_speed(const Path& path, Vec2 robot_in_map, double speed_now_mps, std::span<const Track> tracks,
                    const SpeedChoiceConfig& config) noexcept {
  if (path.empty()) return 0.0;
  constexpr std::array<double, 5> kShares{1.0, 0.75, 0.5, 0.25, 0.0};
  double best_speed = config.max_speed_mps, best_time = -1.0;
  for (const double share : kShares) {
    const double speed = share * config.max_speed_mps;
    const double time = free_time(path, robot_in_map, speed_now_mps, speed, tracks, config);
    const bool at_once = config.stands_at_worst && best_time <= kStep_s;
    if (time > best_time || at_once) best_time = std::max(time, best_time), best_speed = speed;
  }
  return best_speed;
}

}  // namespace jaywalk
