#include "firmware/safety/stop_zone.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace jaywalk {
namespace {

constexpr double kStep_m = 0.04;  // half a 70 mm cylinder and a bit: none slips between two steps

}  // namespace

StopZone::StopZone(const StopZoneConfig& config)
    : config_(config), rim_radius_m_(config.footprint.circumscribed_radius_m()) {}

double StopZone::rim_speed_mps(const Twist2& twist) const noexcept {
  return std::fabs(twist.v_mps) + std::fabs(twist.w_radps) * rim_radius_m_;
}

double StopZone::speed_to_stop_within(double gap_m) const noexcept {
  if (!(gap_m > 0.0)) return 0.0;
  const double bt = config_.brake_mps2 * config_.reaction_s;
  return std::sqrt(bt * bt + 2.0 * config_.brake_mps2 * gap_m) - bt;
}

double StopZone::gap_m(const LaserScan& scan, const Twist2& twist) const noexcept {
  const double rim_speed = rim_speed_mps(twist);
  double gap = std::numeric_limits<double>::infinity();
  if (rim_speed < 1e-9) return gap;
  const double step_s = kStep_m / rim_speed;
  const Pose2 step{twist.v_mps * step_s, 0.0, twist.w_radps * step_s};  // half a step's turn off: below 0.3 mm
  const Transform2 robot_from_laser(config_.robot_from_laser);
  const double reach_m = rim_radius_m_ + config_.margin_m + config_.look_ahead_m;
  const Vec2 turn_back = direction(-step.heading);
  for (std::size_t beam = 0; beam < scan.beam_count; ++beam) {
    if (!scan.is_hit(beam)) continue;
    Vec2 p = robot_from_laser * (direction(scan.angle_rad(beam)) * static_cast<double>(scan.range_m[beam]));
    if (norm(p) > reach_m) continue;
    const double clearance_now = config_.footprint.distance_to(p);
    const double limit = std::min(gap, config_.look_ahead_m);
    for (double gone_m = kStep_m; gone_m <= limit; gone_m += kStep_m) {
      const Vec2 q{p.x - step.x, p.y};  // the point as the moved robot sees it
      p = {turn_back.x * q.x - turn_back.y * q.y, turn_back.y * q.x + turn_back.x * q.y};
      const double clearance = config_.footprint.distance_to(p);
      if (clearance < config_.margin_m && clearance < clearance_now - 1e-4) {
        gap = gone_m - kStep_m;
        break;
      }
      if (clearance_now == 0.0 && clearance == 0.0) {  // touching already, and still after a step
        gap = 0.0;
        break;
      }
    }
    if (gap == 0.0) break;
  }
  return gap;
}

}  // namespace jaywalk
