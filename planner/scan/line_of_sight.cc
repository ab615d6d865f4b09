#include "planner/scan/line_of_sight.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace jaywalk {
namespace {

constexpr double kMostBeamsAside = 3.0;

}  // namespace

LineOfSight::LineOfSight(const LaserScan& scan, const Pose2& map_from_robot, const Pose2& robot_from_laser,
                         const Twist2& twist)
    : scan_(scan),
      map_from_robot_(map_from_robot),
      robot_from_laser_(robot_from_laser),
      twist_(twist),
      beam_s_(beam_interval_s(scan, twist)),
      sweep_(sweep_of(scan)),
      laser_from_map_(inverse(map_from_robot * robot_from_laser)) {}

LineOfSight::Bearing LineOfSight::bearing(Vec2 place, double after_s) const noexcept {
  const Vec2 in_laser = after_s == 0.0
                            ? laser_from_map_ * place
                            : inverse(map_from_robot_ * moved_by(twist_, after_s) * robot_from_laser_) * place;
  const double step = static_cast<double>(scan_.angle_step_rad), turn = 2.0 * kPi / std::fabs(step);
  const double beam = (atan2(in_laser.y, in_laser.x) - static_cast<double>(scan_.first_angle_rad)) / step;
  return {norm(in_laser), beam - turn * std::floor((beam + 0.5) / turn)};  // beam in [-1/2, turn - 1/2)
}

Sight LineOfSight::at(Vec2 place, double tolerance, const BeamRun& but) const noexcept {
  if (scan_.angle_step_rad == 0.0F) return Sight::kUnseen;
  const double beams = sweep_.beams;
  Bearing seen = bearing(place, 0.0);
  if (beam_s_ > 0.0 && seen.beam < beams) seen = bearing(place, seen.beam * beam_s_);
  const auto [away, beam] = seen;
  const bool in_sweep = beams >= 1.0 && beam > -1.0 && beam < beams;  // below: angles that a double cannot tell apart
  if (!(away > tolerance) || !in_sweep) return Sight::kUnseen;
  const double aside =
      std::min(kMostBeamsAside, tolerance / (away * std::fabs(static_cast<double>(scan_.angle_step_rad))));
  const auto first = static_cast<std::ptrdiff_t>(std::floor(beam - aside + 0.5));
  const auto last = static_cast<std::ptrdiff_t>(std::floor(beam + aside + 0.5)), count = std::ptrdiff_t{sweep_.beams};
  const bool in_reach = away < kSeesAll * static_cast<double>(scan_.range_max_m);
  bool goes_on = false, nothing = false, ends = false;
  for (std::ptrdiff_t k = first; k <= last; ++k) {
    if (!sweep_.all_round && (k < 0 || k >= count)) continue;
    const auto b = static_cast<std::size_t>(((k % count) + count) % count);
    if (but.has(b)) continue;
    const double range = static_cast<double>(scan_.range_m[b]);
    if (scan_.is_hit(b) && std::fabs(range - away) < tolerance) return Sight::kThere;
    if (in_reach && scan_.found_nothing(b)) {
      nothing = true;
    } else {
      (scan_.is_hit(b) && range > away ? goes_on : ends) = true;
    }
  }
  if (ends) return Sight::kUnseen;
  if (nothing) return Sight::kEmpty;
  return goes_on ? Sight::kThrough : Sight::kUnseen;
}

}  // namespace jaywalk
