#include "apps/formats/logs/wheel_trail.h"

#include <algorithm>
#include <chrono>
#include <cmath>

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

constexpr double kAsideM = 0.01;  // an arc that ends this near is the way that was driven
// A robot that hardly drives does not turn far to get a few centimetres aside: that is slip, or a hop of the
// recording's.
constexpr double kMostSlipM = 0.03, kMostBentRad = 0.26;
constexpr Duration kOften = std::chrono::milliseconds(100), kLongestFilled = std::chrono::milliseconds(1500);
constexpr Duration kSparse = std::chrono::milliseconds(150);  // in less a robot does not turn, drive and turn back

/// What an arc to `to` would miss it by, sideways.
double arc_misses_by(const Driven& driven, const Pose2& to) {
  const double turn = wrap_angle(to.heading - driven.pose.heading);
  return std::fabs(cross(direction(driven.pose.heading + turn / 2.0), to.position() - driven.pose.position()));
}

/// The heading to drive straight to `to` with: ahead, or backwards where that is less of a turn.
double heading_towards(const Driven& driven, const Pose2& to) {
  const Vec2 way = to.position() - driven.pose.position();
  const double ahead = atan2(way.y, way.x);
  return std::fabs(wrap_angle(ahead - driven.pose.heading)) <= kPi / 2 ? ahead : wrap_angle(ahead + kPi);
}

/// Whether it got to `to` by turning, driving straight and turning.
bool turns_and_drives(const Driven& driven, const Pose2& to) {
  const double miss_m = arc_misses_by(driven, to);
  const double bent = wrap_angle(heading_towards(driven, to) - driven.pose.heading);
  return miss_m > kMostSlipM || (miss_m > kAsideM && std::fabs(bent) < kMostBentRad);
}

/// Stamps a reading; its speeds, where the recording says none, are the mean ones since `before`.
void stamp_reading(WheelState& now, Time stamp, const WheelState& before) {
  now.stamp = stamp;
  ++now.sequence;
  if (before.sequence == 0) return;
  const double dt = to_seconds(stamp - before.stamp);
  if (!(dt > 0.0)) return;
  now.left_radps = (now.left_rad - before.left_rad) / dt;
  now.right_radps = (now.right_rad - before.right_rad) / dt;
}

}  // namespace

DriveModel nominal_drive() { return {.wheel_radius_m = 0.1, .track_width_m = 0.5, .max_wheel_speed_radps = 100.0}; }

std::vector<WheelState> wheel_trail(const std::vector<OdometryPose>& poses, const DriveModel& drive) {
  std::vector<WheelState> trail;
  trail.reserve(3 * poses.size());
  Driven driven;
  if (!poses.empty()) driven.pose = poses.front().pose;
  const auto drive_to = [&](const Pose2& to, Time stamp) {
    const WheelState before = driven.wheels;
    drive_arc(driven, to, drive);
    stamp_reading(driven.wheels, stamp, before);
    trail.push_back(driven.wheels);
  };
  for (const OdometryPose& next : poses) {
    const bool sparse = !trail.empty() && next.stamp - trail.back().stamp > kSparse;
    if (sparse && turns_and_drives(driven, next.pose)) {
      const Time since = trail.back().stamp;
      const Duration third = (next.stamp - since) / 3;
      const double heading = heading_towards(driven, next.pose);
      drive_to({driven.pose.x, driven.pose.y, heading}, since + third);
      drive_to({next.pose.x, next.pose.y, heading}, since + 2 * third);
    }
    drive_to(next.pose, next.stamp);
    if (!next.twist) continue;
    const double apart = next.twist->w_radps * drive.track_width_m / 2.0;
    trail.back().left_radps = (next.twist->v_mps - apart) / drive.wheel_radius_m;
    trail.back().right_radps = (next.twist->v_mps + apart) / drive.wheel_radius_m;
  }
  return trail;
}

std::vector<WheelState> filled_in(const std::vector<WheelState>& trail) {
  std::vector<WheelState> filled;
  filled.reserve(2 * trail.size());
  for (const WheelState& next : trail) {
    const WheelState last = filled.empty() ? next : filled.back();
    const Duration gap = next.stamp - last.stamp;
    const std::int64_t steps = gap <= kLongestFilled ? (gap + kOften - Duration{1}) / kOften : 1;
    for (std::int64_t k = 1; k < steps; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(steps);
      WheelState between = filled.back();
      between.left_rad = last.left_rad + share * (next.left_rad - last.left_rad);
      between.right_rad = last.right_rad + share * (next.right_rad - last.right_rad);
      stamp_reading(between, last.stamp + gap * k / steps, filled.back());
      filled.push_back(between);
    }
    filled.push_back(next);
    filled.back().sequence = static_cast<std::uint32_t>(filled.size());
  }
  return filled;
}

DriveTimes report_times(const std::vector<WheelState>& trail) {
  constexpr double kLongestReport_s = 0.25, kLatest_s = 0.2;
  DriveTimes times;
  std::vector<double> periods_s;
  for (std::size_t k = 1; k < trail.size(); ++k) periods_s.push_back(to_seconds(trail[k].stamp - trail[k - 1].stamp));
  if (periods_s.empty()) return times;
  std::sort(periods_s.begin(), periods_s.end());
  const double middle_s = std::min(periods_s[periods_s.size() / 2], kLongestReport_s);
  times.report_s = std::max(times.report_s, middle_s);
  times.late_s = std::clamp(periods_s[periods_s.size() * 19 / 20] - times.report_s, 0.0, kLatest_s);
  return times;
}

}  // namespace jaywalk::sim
