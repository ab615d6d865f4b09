#include "hal/sim/logs/wheel_trail.h"

namespace jaywalk::sim {
namespace {

/// x / sin(x); the series where the quotient loses digits.
double arc_over_chord(double x) { return x * x < 1e-8 ? 1.0 + x * x / 6.0 : x / sin(x); }

/// Where the drive stands after its readings so far, and what they read.
struct Driven {
  Pose2 pose;
  WheelState wheels;
};

/// Drives the arc that ends with `to`'s heading and as near to its position as an arc can.
void drive_arc(Driven& driven, const Pose2& to, const DriveModel& drive) {
  const double turn = wrap_angle(to.heading - driven.pose.heading);
  const Vec2 along = direction(driven.pose.heading + turn / 2.0);
  const double chord = dot(to.position() - driven.pose.position(), along);
  const double arc = chord * arc_over_chord(turn / 2.0);
  const double apart = turn * drive.track_width_m / 2.0;
  const Vec2 reached = driven.pose.position() + along * chord;
  driven.pose = {reached.x, reached.y, to.heading};
  driven.wheels.left_rad += (arc - apart) / drive.wheel_radius_m;
  driven.wheels.right_rad += (arc + apart) / drive.wheel_radius_m;
}

}  // namespace

DriveModel nominal_drive() { return {.wheel_radius_m = 0.1, .track_width_m = 0.5, .max_wheel_speed_radps = 100.0}; }

std::vector<WheelState> wheel_trail(const std::vector<OdometryPose>& poses, const DriveModel& drive) {
  std::vector<WheelState> trail;
  trail.reserve(poses.size());
  Driven driven;
  if (!poses.empty()) driven.pose = poses.front().pose;
  for (const OdometryPose& next : poses) {
    const WheelState before = driven.wheels;
    drive_arc(driven, next.pose, drive);
    WheelState& now = driven.wheels;
    now.stamp = next.stamp;
    ++now.sequence;
    if (next.twist) {
      const double apart = next.twist->w_radps * drive.track_width_m / 2.0;
      now.left_radps = (next.twist->v_mps - apart) / drive.wheel_radius_m;
      now.right_radps = (next.twist->v_mps + apart) / drive.wheel_radius_m;
    } else if (!trail.empty()) {
      const double dt = to_seconds(now.stamp - before.stamp);
      now.left_radps = (now.left_rad - before.left_rad) / dt;
      now.right_radps = (now.right_rad - before.right_rad) / dt;
    }
    trail.push_back(now);
  }
  return trail;
}

}  // namespace jaywalk::sim
