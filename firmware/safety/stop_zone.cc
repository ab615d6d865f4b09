#include "firmware/safety/stop_zone.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace jaywalk {
namespace {

constexpr double kStep_m = 0.04;  // half a 70 mm cylinder and a bit: none slips between two steps

/// Where a beam ends, in the laser's frame.
Vec2 end_of(const LaserScan& scan, std::size_t beam) {
  return direction(scan.angle_rad(beam)) * static_cast<double>(scan.range_m[beam]);
}

}  // namespace

StopZone::StopZone(const StopZoneConfig& config)
    : config_(config), rim_radius_m_(config.footprint.circumscribed_radius_m()) {}

double StopZone::rim_speed_mps(const Twist2& twist) const noexcept {
  return std::fabs(twist.v_mps) + std::fabs(twist.w_radps) * rim_radius_m_;
}

double StopZone::margin_at(double rim_mps) const noexcept {
  const double share = std::min(rim_mps / kFullMargin_mps, 1.0);
  return config_.creep_margin_m + (config_.margin_m - config_.creep_margin_m) * share;
}

double StopZone::speed_to_stop_within(double gap_m, Duration sweep) const noexcept {
  if (!(gap_m > 0.0)) return 0.0;
  const double bt = config_.brake_mps2 * (config_.reaction_s + to_seconds(sweep));
  return std::sqrt(bt * bt + 2.0 * config_.brake_mps2 * gap_m) - bt;
}

double StopZone::gap_m(const LaserScan& scan, const Twist2& twist) const noexcept {
  const double rim_speed = rim_speed_mps(twist);
  double gap = std::numeric_limits<double>::infinity();
  if (rim_speed < 1e-9) return gap;
  const double step_s = kStep_m / rim_speed;
  // Driving a chord and then turning differs from the arc by less than 0.3 mm a step.
  const Step step{twist.v_mps * step_s, direction(-twist.w_radps * step_s)};
  const Transform2 robot_from_laser(config_.robot_from_laser);
  const double margin = margin_at(rim_speed);
  const double reach_m = rim_radius_m_ + config_.margin_m + config_.look_ahead_m;
  for (std::size_t beam = 0; beam < scan.beam_count; ++beam) {
    if (!scan.is_hit(beam)) continue;
    const Vec2 hit = robot_from_laser * end_of(scan, beam);
    if (norm(hit) <= reach_m) gap = std::min(gap, way_to(hit, step, margin, std::min(gap, config_.look_ahead_m)));
  }
  return gap;
}

bool StopZone::is_on_body(const LaserScan& scan, std::size_t beam) const noexcept {
  return scan.is_hit(beam) && config_.footprint.distance_to(config_.robot_from_laser * end_of(scan, beam)) == 0.0;
}

std::size_t StopZone::beams_on_body(const LaserScan& scan) const noexcept {
  std::size_t count = 0;
  for (std::size_t beam = 0; beam < scan.beam_count; ++beam) count += is_on_body(scan, beam) ? 1U : 0U;
  return count;
}

double StopZone::way_to(Vec2 point, const Step& step, double margin_m, double most_m) const noexcept {
  const double clearance_now = config_.footprint.distance_to(point);
  double before = clearance_now;
  const int steps = static_cast<int>(most_m / kStep_m) + 1;
  for (int k = 0; k < steps; ++k) {
    const Vec2 q{point.x - step.ahead_m, point.y};  // as the moved robot sees it
    point = {step.turn_back.x * q.x - step.turn_back.y * q.y, step.turn_back.y * q.x + step.turn_back.x * q.y};
    const double clearance = config_.footprint.distance_to(point);
    const bool still_touching = clearance_now == 0.0 && clearance == 0.0;
    if (still_touching || (clearance < margin_m && clearance < clearance_now - 1e-4)) {
      // The margin is met within this step, where the clearance has fallen to it; at once where it had before.
      const double within = before > margin_m ? (before - margin_m) / (before - clearance) : 0.0;
      return (k + within) * kStep_m;
    }
    before = clearance;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace jaywalk
