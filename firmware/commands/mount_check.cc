#include "firmware/commands/mount_check.h"

#include <cmath>

namespace jaywalk {
namespace {

constexpr double kEnough_m = 5.0;
constexpr double kSlide_rad = 0.1;

}  // namespace

void MountCheck::add(const Pose2& map_from_robot) {
  if (begun_) driven_in_robot_ = driven_in_robot_ + inverse(before_) * map_from_robot.position();
  begun_ = true;
  before_ = map_from_robot;
}

std::optional<double> MountCheck::missing_yaw() const {
  if (norm(driven_in_robot_) < kEnough_m) return std::nullopt;
  // A laser that looks to the left by some yaw, taken for one that looks ahead, sees the robot slide to the right by
  // it.
  const double slide = atan2(driven_in_robot_.y, driven_in_robot_.x);
  return std::fabs(slide) > kSlide_rad ? std::optional(-slide) : std::nullopt;
}

}  // namespace jaywalk
