#include "planner/scan/line_of_sight.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>

#include "hal/types/trig.h"

namespace jaywalk {
namespace {
constexpr double kMostBeamsAside = 3.0;

constexpr double kWidestHalfRad = 0.6, kNarrowestRad = 1e-6;
constexpr int kSteps = 4;  // of the fixed point: a millimetre of a disc of 0.5 m at 1 m

double asin(double x) {
  x = std::clamp(x, -1.0, 1.0);
  return atan2(x, std::sqrt(1.0 - x * x));
}

/// F of the header, of a disc that is `s` of its centre's range in radius.
double sum_up_to(double t, double s) {
  const double u = sin(t);
  return 0.5 * (t + u * cos(t) - u * std::sqrt(std::max(0.0, s * s - u * u)) - s * s * asin(u / s));
}

/// Mean of the points from `t0` to `t1` along the centre's bearing, as a share of the centre's range.
double mean_share(double t0, double t1, double s) { return (sum_up_to(t1, s) - sum_up_to(t0, s)) / (t1 - t0); }

constexpr Duration kSince = std::chrono::milliseconds(1000), kUntil = std::chrono::milliseconds(400);
constexpr Duration kApart = std::chrono::milliseconds(45);
constexpr double kNoise_m = 0.05, kNoiseShare = 0.012;  // of a range, as wide as poses and ranges are unsure

}  // namespace

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

SeenDisc seen_disc(double mean_range, double angle) noexcept {
  const double half = std::clamp(0.5 * angle, kNarrowestRad, kWidestHalfRad), s = sin(half);
  const double range = mean_range / mean_share(-half, half, s);
  return {range, range * s, half};
}

SeenDisc seen_side(double radius, double angle, double mean_range, double mean_bearing) noexcept {
  SeenDisc disc{mean_range + kArcMean * radius, radius, 0.0};
  for (int k = 0; k < kSteps; ++k) {
    const double s = std::min(radius / disc.range_m, sin(kWidestHalfRad)), half = asin(s);
    const double seen = std::clamp(angle, kNarrowestRad, 2.0 * half);
    disc.bearing_rad = half;
    disc.range_m = mean_range * cos(half - mean_bearing) / mean_share(-half, seen - half, s);
  }
  return disc;
}

void PastScans::keep(const LaserScan& scan, const Pose2& map_from_robot, const Pose2& robot_from_laser,
                     const Twist2& twist) noexcept {
  if (count_ > 0) {
    const LaserScan& last = (*kept_)[(count_ - 1) % kMost].scan;
    if (last.scanner == scan.scanner && scan.stamp >= last.stamp && scan.stamp - last.stamp < kApart) return;
  }
  (*kept_)[count_++ % kMost] = {scan, map_from_robot, robot_from_laser, twist};
}

std::optional<double> PastScans::seen_through(std::span<const Vec2> places, Time now) const noexcept {
  int through = 0, told = 0;
  for (std::size_t k = 0; k < std::min(count_, kMost); ++k) {
    const Kept& kept = (*kept_)[k];
    if (kept.scan.stamp > now - kUntil || kept.scan.stamp < now - kSince) continue;
    const LineOfSight sight(kept.scan, kept.map_from_robot, kept.robot_from_laser, kept.twist);
    const Vec2 laser = (kept.map_from_robot * kept.robot_from_laser).position();
    for (const Vec2& place : places) {
      const Sight seen = sight.at(place, kNoise_m + kNoiseShare * distance(laser, place));
      told += seen != Sight::kUnseen ? 1 : 0;
      through += seen == Sight::kThrough || seen == Sight::kEmpty ? 1 : 0;
    }
  }
  if (told == 0) return std::nullopt;
  return static_cast<double>(through) / told;
}

}  // namespace jaywalk
