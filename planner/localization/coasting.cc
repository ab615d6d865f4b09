#include "planner/localization/coasting.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

constexpr double kAccelStd = 1.5;                         // m/s^2
constexpr double kTurnAccelStd = 3.0;                     // rad/s^2
constexpr double kLongestCoastS = 3.0;                    // by then it is 13 m off: as good as anywhere
constexpr double kLongestStepS = 1.0;                     // that tells a speed
constexpr double kLeastS = 0.1;                           // that its speed had to change in
constexpr double kFastestMps = 2.5, kFastestRadps = 3.0;  // beyond, the match was wrong
constexpr double kForget = 0.8;                           // of the speed, a scan that did not match
constexpr double kTwistGain = 0.7;                        // of the running mean of speeds between matches

}  // namespace

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
