#include "planner/localization/coasting.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

constexpr double kAccelStd = 1.5;                         // m/s^2
constexpr double kTurnAccelStd = 3.0;                     // rad/s^2
constexpr double kLongestCoastS = 1.0;                    // after a longer gap it is taken to have stood
constexpr double kLeastS = 0.1;                           // that its speed had to change in
constexpr double kFastestMps = 2.5, kFastestRadps = 3.0;  // beyond, the match was wrong
constexpr double kForget = 0.8;                           // of the speed, a scan that did not match
constexpr double kTwistGain = 0.7;                        // of the running mean of speeds between matches

}  // namespace

Coasting::Step Coasting::since_last_scan(Time stamp) const noexcept {
  const bool gap = last_stamp_ == kNever || stamp <= last_stamp_ || to_seconds(stamp - last_stamp_) > kLongestCoastS;
  const double dt = gap ? 0.0 : to_seconds(stamp - last_stamp_);
  return {.before_from_after = {velocity_in_robot_.x * dt, velocity_in_robot_.y * dt, turn_radps_ * dt},
          .metres_std = kAccelStd * dt * std::max(dt, kLeastS),
          .radians_std = kTurnAccelStd * dt * std::max(dt, kLeastS)};
}

void Coasting::placed(const Pose2& map_from_robot, Time stamp) noexcept {
  const double dt = last_stamp_ == kNever ? 0.0 : to_seconds(stamp - last_stamp_);
  const Pose2 step = inverse(last_) * map_from_robot;
  const bool believable = dt > 0.0 && dt < kLongestCoastS && norm(step.position()) < kFastestMps * dt &&
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
