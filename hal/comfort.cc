#include "hal/comfort.h"

#include <algorithm>

namespace jaywalk {

const std::vector<std::string>& comfort_names() {
  static const std::vector<std::string> names{"gentle", "normal", "brisk"};
  return names;
}

// Gentle and brisk were chosen, not tuned; docs/reference/scenarios.md has what they come to.
ComfortProfile profile_of(Comfort comfort) noexcept {
  switch (comfort) {
    case Comfort::kGentle:
      return {.speed = 0.65, .accel = 0.6, .jerk = 0.6, .comfort_distance_m = 1.5};
    case Comfort::kBrisk:
      return {.speed = 1.0, .accel = 1.6, .jerk = 1.2, .comfort_distance_m = 0.75};
    case Comfort::kNormal:
      break;
  }
  return {};
}

MotionLimits limits_for(Comfort comfort, const RobotModel& model) noexcept {
  const ComfortProfile profile = profile_of(comfort);
  const auto capped = [](double own, double share, double most) { return std::min(own * share, std::max(own, most)); };
  MotionLimits limits = model.limits;
  limits.max_speed_mps *= profile.speed;
  limits.max_turn_radps *= profile.speed;
  limits.max_accel_mps2 = capped(limits.max_accel_mps2, profile.accel, kMostComfortAccel_mps2);
  limits.max_turn_accel_radps2 *= std::min(profile.accel, 1.0);
  limits.max_jerk_mps3 = capped(limits.max_jerk_mps3, profile.jerk, kMostComfortJerk_mps3);
  return limits;
}

}  // namespace jaywalk
