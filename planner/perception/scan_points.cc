#include "planner/perception/scan_points.h"

#include <algorithm>

namespace jaywalk {
namespace {

/// Ranges beyond are no laser's: whatever a scan claims, cell indices stay small.
constexpr double kFarthestBelievedM = 1000.0;

/// Nearer than this a laser sees only its own robot: masts, cables, the rim of its own window.
constexpr double kNearestM = 0.2;

/// Where the robot stands `after_s` seconds after the stamp, seen from where it stood at the stamp. A sweep is short:
/// the chord's direction is taken at half the turn, which is exact for constant speeds up to (w t)^2 / 24.
Transform2 moved_by(const Twist2& twist, double after_s) {
  const double turn = twist.w_radps * after_s;
  const Vec2 travel = direction(0.5 * turn) * (twist.v_mps * after_s);
  return Transform2({travel.x, travel.y, turn});
}

}  // namespace

void project_scan(const LaserScan& scan, const Pose2& robot_from_laser, const Twist2& twist, ScanPoints& out) noexcept {
  out.clear();
  const std::size_t beams = std::min<std::size_t>(scan.beam_count, kMaxBeams);
  const double beam_s = beams > 1 ? to_seconds(scan.sweep) / static_cast<double>(beams - 1) : 0.0;
  const bool skewed = beam_s != 0.0 && !(twist == Twist2{});
  const Transform2 at_stamp(robot_from_laser);
  for (std::size_t b = 0; b < beams; ++b) {
    const double range = static_cast<double>(scan.range_m[b]);
    if (!scan.is_hit(b) || range < kNearestM || range > kFarthestBelievedM) continue;
    Vec2 p = at_stamp * (direction(scan.angle_rad(b)) * range);
    if (skewed) p = moved_by(twist, beam_s * static_cast<double>(b)) * p;
    (void)out.push_back({p, range, static_cast<std::uint32_t>(b)});  // never full: one point a beam
  }
}

}  // namespace jaywalk
