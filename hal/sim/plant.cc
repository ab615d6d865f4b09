#include "hal/sim/plant.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace jaywalk::sim {

Plant::Plant(const RobotModel& model, const Pose2& start, std::uint64_t seed, const SlipSpec& slip,
             const TrueRobot& truth)
    : track_m_(truth.track_width_m.value_or(model.drive.track_width_m)),
      max_speed_(model.drive.max_wheel_speed_radps),
      max_accel_(kAccelOverBrake * model.limits.brake_mps2 / model.drive.wheel_radius_m),
      slip_(slip),
      map_from_robot_(start),
      left_{truth.left_wheel_radius_m.value_or(model.drive.wheel_radius_m)},
      right_{truth.right_wheel_radius_m.value_or(model.drive.wheel_radius_m)},
      random_(seed, Purpose::kSlip) {}

/// Speed' = (wanted - speed) / lag, bounded; the wheel's mean speed over the step turns it.
double Plant::turn(Wheel& wheel, double step_s, bool alive) const noexcept {
  const double wanted = alive ? wheel.wanted : 0.0;
  const double accel = std::clamp((wanted - wheel.speed) / kMotorLag, -max_accel_, max_accel_);
  const double before = wheel.speed;
  wheel.speed += accel * step_s;
  const double turned = 0.5 * (before + wheel.speed) * step_s;
  wheel.angle += turned;
  return turned * wheel.radius_m * (1.0 - slip_.mean - wheel.slip) * wheel.grip;
}

/// The ground passes l and r under the two wheels: the middle moves (l + r)/2 and turns (r - l)/track; the step runs
/// along the heading that the robot has half way through it.
void Plant::step(double step_s, Time now) noexcept {
  const bool alive = age(commanded_, now) <= kDriveWatchdog;
  if (wiring_.left_stuck) left_.speed = left_.wanted = 0.0;
  double left = turn(left_, step_s, alive) * wiring_.left_ground, right = turn(right_, step_s, alive);
  if (wiring_.swapped) std::swap(left, right);
  const double forward = 0.5 * (left + right), turned = (right - left) / track_m_;
  twist_ = {forward / step_s, turned / step_s};
  const Vec2 moved = direction(map_from_robot_.heading + 0.5 * turned) * forward;
  map_from_robot_ = {map_from_robot_.x + moved.x, map_from_robot_.y + moved.y,
                     wrap_angle(map_from_robot_.heading + turned)};
}

WheelState Plant::read_encoders(Time now) noexcept {
  constexpr double kRadPerTick = 2.0 * kPi / kTicksPerTurn;
  const auto whole_ticks = [](double angle) { return std::floor(angle / kRadPerTick) * kRadPerTick; };
  const double left = whole_ticks(left_.angle), right = whole_ticks(right_.angle);
  const double since = reading_.sequence == 0 ? 0.0 : to_seconds(now - reading_.stamp);
  const double per_second = since > 0.0 ? 1.0 / since : 0.0;
  reading_ = {.stamp = now,
              .sequence = reading_.sequence + 1,
              .left_rad = left,
              .right_rad = right,
              .left_radps = (left - reading_.left_rad) * per_second,
              .right_radps = (right - reading_.right_rad) * per_second};
  return reading_;
}

}  // namespace jaywalk::sim
