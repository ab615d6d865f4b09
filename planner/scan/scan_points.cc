#include "planner/scan/scan_points.h"

#include <algorithm>
#include <cmath>

#include "hal/types/trig.h"

namespace jaywalk {
namespace {

/// Ranges beyond are no laser's: whatever a scan claims, cell indices stay small.
constexpr double kFarthestBelievedM = 1000.0;

/// Nor does it take longer over one.
constexpr double kLongestSweepS = 1.0;

/// No scanner counts its turns as far: such angles are none.
constexpr float kMostRad = 100.0F;

}  // namespace

Sweep sweep_of(const LaserScan& scan) noexcept {
  const auto beams = static_cast<std::uint32_t>(std::min<std::size_t>(scan.beam_count, kMaxBeams));
  const double step = static_cast<double>(scan.angle_step_rad);
  const double past_a_turn = std::fabs(step) * beams - 2.0 * kPi;  // a step: the first direction is looked along twice
  const bool all_round = past_a_turn > -0.5 * std::fabs(step) && past_a_turn < 1.5 * std::fabs(step);
  const double sweep_s = std::clamp(to_seconds(scan.sweep), 0.0, kLongestSweepS);
  return {beams, step, all_round, sweep_s / std::max(1.0, beams - 1.0)};
}

double beam_interval_s(const LaserScan& scan, const Twist2& twist) noexcept {
  if (scan.beam_count < 2 || twist == Twist2{}) return 0.0;
  return to_seconds(scan.sweep) / static_cast<double>(scan.beam_count - 1);
}

Pose2 moved_by(const Twist2& twist, double after_s) noexcept {
  const double turn = twist.w_radps * after_s;
  const Vec2 travel = direction(0.5 * turn) * (twist.v_mps * after_s);
  return {travel.x, travel.y, turn};
}

void ScanProjection::look_along(const LaserScan& scan, std::size_t beams) noexcept {
  if (scan.first_angle_rad != first_angle_rad_ || scan.angle_step_rad != angle_step_rad_) known_ = 0;
  first_angle_rad_ = scan.first_angle_rad;
  angle_step_rad_ = scan.angle_step_rad;
  for (; known_ < beams; ++known_) direction_[known_] = direction(scan.angle_rad(known_));
}

template <class RangeOf>
void ScanProjection::project_beams(const LaserScan& scan, const Pose2& robot_from_laser, const Twist2& twist,
                                   RangeOf range_of, ScanPoints& out) noexcept {
  out.clear();
  const std::size_t beams = std::min<std::size_t>(scan.beam_count, kMaxBeams);
  if (!(std::fabs(scan.first_angle_rad) < kMostRad && std::fabs(scan.angle_step_rad) < kMostRad)) return;  // NaN too
  look_along(scan, beams);
  const double beam_s = beam_interval_s(scan, twist);
  const Transform2 at_stamp(robot_from_laser);
  for (std::size_t b = 0; b < beams; ++b) {
    const double range = range_of(b);
    if (range == 0.0) continue;
    Vec2 p = at_stamp * (direction_[b] * range);
    if (beam_s != 0.0) p = Transform2(moved_by(twist, beam_s * static_cast<double>(b))) * p;
    (void)out.push_back({p, range, static_cast<std::uint32_t>(b)});  // never full: one point a beam
  }
}

void ScanProjection::project(const LaserScan& scan, const Pose2& robot_from_laser, const Twist2& twist,
                             ScanPoints& out) noexcept {
  const auto range_of = [&scan](std::size_t b) {
    const double range = static_cast<double>(scan.range_m[b]);
    return !scan.is_hit(b) || range < kNearestSeenM || range > kFarthestBelievedM ? 0.0 : range;
  };
  project_beams(scan, robot_from_laser, twist, range_of, out);
}

void ScanProjection::project_empty(const LaserScan& scan, const Pose2& robot_from_laser, const Twist2& twist,
                                   double range_m, ScanPoints& out) noexcept {
  const auto range_of = [&](std::size_t b) { return scan.found_nothing(b) ? range_m : 0.0; };
  project_beams(scan, robot_from_laser, twist, range_of, out);
}

}  // namespace jaywalk
