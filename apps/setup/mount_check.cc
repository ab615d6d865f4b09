#include "apps/setup/mount_check.h"

#include <cmath>

namespace jaywalk {
namespace {

constexpr double kEnough_m = 5.0;
// Where it turns more a metre, a laser that stands before the axle, or beside it, swings to the side as well.
constexpr double kStraight_radpm = 0.15;

}  // namespace

void MountCheck::add(const Pose2& map_from_robot) {
  const Vec2 step = inverse(before_) * map_from_robot.position();
  const double turn = wrap_angle(map_from_robot.heading - before_.heading);
  if (begun_ && std::fabs(turn) < kStraight_radpm * norm(step)) driven_in_robot_ = driven_in_robot_ + step;
  begun_ = true;
  before_ = map_from_robot;
}

std::optional<double> MountCheck::slide() const {
  if (norm(driven_in_robot_) < kEnough_m) return std::nullopt;
  return atan2(driven_in_robot_.y, driven_in_robot_.x);
}

std::optional<double> MountCheck::missing_yaw() const {
  const std::optional<double> slid = slide();
  if (!slid || std::fabs(*slid) <= kTells_rad) return std::nullopt;
  // A laser that looks to the left by some yaw, taken for one that looks ahead, sees the robot slide to the right by
  // it.
  return -*slid;
}

}  // namespace jaywalk
