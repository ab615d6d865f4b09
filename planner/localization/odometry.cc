#include "planner/localization/odometry.h"

#include <cmath>

namespace jaywalk {
namespace {
constexpr double kSilentS = 0.25;                              // a wheelchair's speed changes by 0.25 m/s in it
constexpr double kSilentPeriods = 2.5, kLongestPeriodS = 1.0;  // or so many of their own, where they are slower
constexpr double kUnbelievable = 2.0;                          // times the fastest that the motors can do

/// sin(x)/x; below 1e-3 its series is exact to 1e-14.
double sinc(double x) { return std::fabs(x) < 1e-3 ? 1.0 - x * x / 6.0 : sin(x) / x; }

Pose2 between(const Pose2& a, const Pose2& b, double share) {
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y),
          wrap_angle(a.heading + share * wrap_angle(b.heading - a.heading))};
}

Twist2 twist_of(const WheelState& wheels, const DriveModel& drive) {
  const double left = wheels.left_radps * drive.wheel_radius_m, right = wheels.right_radps * drive.wheel_radius_m;
  if (!std::isfinite(left) || !std::isfinite(right)) return {};
  return {0.5 * (left + right), (right - left) / drive.track_width_m};
}

constexpr double kAccelStd = 1.5;                         // m/s^2
constexpr double kTurnAccelStd = 3.0;                     // rad/s^2
constexpr double kLongestCoastS = 3.0;                    // by then it is 13 m off: as good as anywhere
constexpr double kLongestStepS = 1.0;                     // that tells a speed
constexpr double kLeastS = 0.1;                           // that its speed had to change in
constexpr double kFastestMps = 2.5, kFastestRadps = 3.0;  // beyond, the match was wrong
constexpr double kForget = 0.8;                           // of the speed, a scan that did not match
constexpr double kTwistGain = 0.7;                        // of the running mean of speeds between matches

}  // namespace

Pose2 after_arc(const Pose2& from, const ArcStep& step) noexcept {
  const double chord = step.distance_m * sinc(0.5 * step.turn_rad);
  const Vec2 travel = direction(from.heading + 0.5 * step.turn_rad) * chord;
  return {from.x + travel.x, from.y + travel.y, wrap_angle(from.heading + step.turn_rad)};
}

bool Odometry::believable(const ArcStep& step, double seconds) const noexcept {
  if (!std::isfinite(step.distance_m) || !std::isfinite(step.turn_rad)) return false;
  if (drive_.max_wheel_speed_radps <= 0.0) return true;  // not known
  const double wheel_m = std::fabs(step.distance_m) + 0.5 * std::fabs(step.turn_rad) * drive_.track_width_m;
  const double fastest_mps = drive_.max_wheel_speed_radps * drive_.wheel_radius_m;
  return wheel_m <= kUnbelievable * fastest_mps * std::max(seconds, 0.0) + drive_.wheel_radius_m;
}

ArcStep Odometry::since_last(const WheelState& wheels) const noexcept {
  if (last_.sequence == 0) return {};
  if (coasted_) {
    const double seconds = std::clamp(to_seconds(wheels.stamp) - to_seconds(newest().stamp), 0.0, kSilentS);
    const Twist2 now = twist_of(wheels, drive_);
    const ArcStep step{now.v_mps * seconds, now.w_radps * seconds};
    return believable(step, seconds) ? step : ArcStep{};
  }
  const ArcStep step = counted(wheels);
  return believable(step, to_seconds(wheels.stamp - last_.stamp)) ? step : ArcStep{};
}

ArcStep Odometry::take(const WheelState& wheels) noexcept {
  const bool bridge = bridges(wheels);
  const Pose2 from = bridge ? odom_from_robot_at_last_ : odom_from_robot();
  ArcStep step = bridge ? counted(wheels) : since_last(wheels);
  step.turn_rad += radius_bias_ * step.distance_m;
  if (last_.sequence != 0)
    period_s_ = std::clamp(to_seconds(wheels.stamp) - to_seconds(last_.stamp), 0.0, kLongestPeriodS);
  last_ = wheels;
  coasted_ = false;
  twist_ = twist_of(wheels, drive_);
  twist_.w_radps += radius_bias_ * twist_.v_mps;
  odom_from_robot_at_last_ = after_arc(from, step);
  if (bridge) forgotten_ = count_;  // the guesses
  remember({wheels.stamp, odom_from_robot_at_last_});
  return step;
}

bool Odometry::wheels_silent(Time stamp) const noexcept {
  const double silent_s = std::max(kSilentS, kSilentPeriods * period_s_);
  return !by_wheels() || to_seconds(stamp) - to_seconds(last_.stamp) > silent_s;
}

bool Odometry::remembers(Time stamp) const noexcept {
  if (count_ == 0) return true;
  return stamp >= entries_[oldest() % kRemembered].stamp && to_seconds(stamp) - to_seconds(newest().stamp) <= kSilentS;
}

Pose2 Odometry::at(Time stamp) const noexcept {
  if (count_ == 0) return {};
  if (stamp >= newest().stamp) {
    const double ahead = std::min(to_seconds(stamp - newest().stamp), kSilentS);
    return after_arc(odom_from_robot(), {twist_.v_mps * ahead, twist_.w_radps * ahead});
  }
  for (std::size_t k = count_ - 1; k > oldest(); --k) {
    const Entry &after = entries_[k % kRemembered], &before = entries_[(k - 1) % kRemembered];
    if (before.stamp > stamp) continue;
    const double span = to_seconds(after.stamp - before.stamp);
    const double share = span > 0.0 ? to_seconds(stamp - before.stamp) / span : 0.0;
    return between(before.odom_from_robot, after.odom_from_robot, share);
  }
  return entries_[oldest() % kRemembered].odom_from_robot;
}

Coasting::Step Coasting::step(Time from, Time to) const noexcept {
  if (from == kNever || to <= from) return {};
  const double dt = std::min(to_seconds(to - from), kLongestCoastS);
  const double drove_s = dt < kLongestCoastS ? dt : 0.0;
  return {.before_from_after = {velocity_in_robot_.x * drove_s, velocity_in_robot_.y * drove_s, turn_radps_ * drove_s},
          .metres_std = kAccelStd * dt * std::max(dt, kLeastS),
          .radians_std = kTurnAccelStd * dt * std::max(dt, kLeastS)};
}

void Coasting::placed(const Pose2& map_from_robot, Time stamp) noexcept {
  const double dt = last_stamp_ == kNever ? 0.0 : to_seconds(stamp - last_stamp_);
  const Pose2 step = inverse(last_) * map_from_robot;
  const bool believable = dt > 0.0 && dt < kLongestStepS && norm(step.position()) < kFastestMps * dt &&
                          std::fabs(step.heading) < kFastestRadps * dt;
  if (believable) {
    velocity_in_robot_ = velocity_in_robot_ + (step.position() * (1.0 / dt) - velocity_in_robot_) * kTwistGain;
    turn_radps_ += (step.heading / dt - turn_radps_) * kTwistGain;
  } else {
    velocity_in_robot_ = {};
    turn_radps_ = 0.0;
  }
  last_ = map_from_robot;
  last_stamp_ = stamp;
}

void Coasting::not_placed(const Pose2& map_from_robot, Time stamp) noexcept {
  velocity_in_robot_ = velocity_in_robot_ * kForget;
  turn_radps_ *= kForget;
  last_ = map_from_robot;
  last_stamp_ = stamp;
}

}  // namespace jaywalk
