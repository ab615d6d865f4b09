#include "planner/motion/speed_choice.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/motion/pursuit.h"
#include "planner/tracking/tuning.h"

namespace jaywalk {
namespace {

constexpr double kStep_s = 0.2;  // 0.12 m of travel at 0.6 m/s: finer than a body

/// Goes along a way by arc length.
class PedestrianSample {
 public:
  PedestrianSample(const Way& way, const Pose2& robot)
      : way_(way), robot_(robot), at_(nearest_point(way.places, robot.position())), position_(way.places[at_]) {}
  Vec2 advance(double length_m) {
    const Path& path = way_.places;
    gone_m_ += length_m;
    while (at_ + 1 < path.size()) {
      const double to_next = distance(position_, path[at_ + 1]);
      if (to_next > length_m) {
        position_ = position_ + (path[at_ + 1] - position_) * (length_m / to_next);
        return position_;
      }
      length_m -= to_next;
      position_ = path[++at_];
    }
    return position_;
  }
  [[nodiscard]] Vec2 looking() const { return way_.looking_at(at_, gone_m_, robot_); }

 private:
  const Way& way_;
  const Pose2& robot_;
  std::size_t at_;
  Vec2 position_;
  double gone_m_ = 0.0;
};

/// Whether it walks, or may well: faster than 0.15 m/s and than twice what its speed is uncertain by. The
/// tracker is slow to call a thing moving, since what it calls so changes the plan; here a false alarm costs a little
/// speed.
bool may_walk(const Track& track) {
  const double speed = norm(track.velocity_in_map);
  return track.moving || (speed > 0.15 && speed > 2.0 * std::sqrt(track.covariance.vv));
}

bool meets_a_mover(Vec2 robot, Vec2 ahead, double after_s, std::span<const Track> tracks,
                   const SpeedChoiceConfig& config) {
  for (const Track& track : tracks) {
    if (!may_walk(track) || (config.stands_at_worst && norm(track.velocity_in_map) < kStoppedMps)) continue;
    const Vec2 there = track.position_in_map + track.velocity_in_map * after_s;
    const double spread_m = config.spread_mps * after_s;
    if (in_conflict(robot, ahead, {there, track.velocity_in_map, track.radius_m, spread_m}, config)) return true;
  }
  return false;
}

/// Seconds until the first conflict when speeding up or slowing down to `speed`; the horizon when there is none.
double free_time(const Way& way, const Pose2& robot, double speed_now, double speed, std::span<const Track> tracks,
                 const SpeedChoiceConfig& config) {
  PedestrianSample walker(way, robot);
  double v = speed_now;
  const int steps = static_cast<int>(config.horizon_s / kStep_s);
  for (int k = 1; k <= steps; ++k) {
    const double t = k * kStep_s;
    v += std::clamp(speed - v, -config.max_accel_mps2 * kStep_s, config.max_accel_mps2 * kStep_s);
    const Vec2 there = walker.advance(v * kStep_s);
    if (meets_a_mover(there, walker.looking(), t, tracks, config)) return t;
  }
  return config.horizon_s;
}

}  // namespace

bool in_conflict(Vec2 robot, Vec2 ahead, const PredictedMover& mover, const SpeedChoiceConfig& config) noexcept {
  const double between = config.robot.distance_to(mover.position, robot, ahead) - mover.radius_m - mover.spread_m;
  if (between < config.body_margin_m) return true;
  if (between > config.zone_ahead_m) return false;
  const double speed = norm(mover.velocity);
  if (speed < 1e-6) return false;
  return config.robot.out_of_way(mover.position, mover.velocity * (1.0 / speed), robot, ahead) < mover.spread_m;
}

double choose_speed(const Way& way, const Pose2& map_from_robot, double speed_now_mps, std::span<const Track> tracks,
                    const SpeedChoiceConfig& config) noexcept {
  if (way.places.empty()) return 0.0;
  constexpr std::array<double, 5> kShares{1.0, 0.75, 0.5, 0.25, 0.0};
  double best_speed = config.max_speed_mps, best_time = -1.0;
  for (const double share : kShares) {
    const double speed = share * config.max_speed_mps;
    const double time = free_time(way, map_from_robot, speed_now_mps, speed, tracks, config);
    const bool at_once = config.stands_at_worst && best_time <= kStep_s;
    if (time > best_time || at_once) best_time = std::max(time, best_time), best_speed = speed;
  }
  return best_speed;
}

}  // namespace jaywalk
