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

constexpr double kJumpM = 0.12;     // surfaces closer than this are one thing: a leg is 0.1 m across
constexpr double kJumpSteps = 3.0;  // or than this many beam spacings: a surface seen at 70 degrees
// At a greater slant: the steps on both sides of the jump go within 18 degrees of it and are a third as long at least,
// which ranges noisy by a centimetre keep to. 0.9 to 0.97 and 2 to 3 told nothing apart.
constexpr double kSameWay = 0.95, kLongestJump = 3.0;

/// From point `k` to the next, round the list's end.
Vec2 step_from(const ScanPoints& points, std::size_t k) {
  const std::size_t n = points.size();
  return points[(k + 1) % n].in_robot - points[k % n].in_robot;
}

bool goes_on_as(Vec2 step, Vec2 jump) {
  return dot(step, jump) > kSameWay * norm(step) * norm(jump) && norm(jump) < kLongestJump * norm(step);
}

/// Whether point `k` and the next are one thing: near each other, or of one straight surface seen at a slant.
bool joined(const ScanPoints& points, std::size_t k, const Sweep& sweep) {
  const std::size_t n = points.size();
  const Vec2 jump = step_from(points, k);
  const double farther_m = std::max(points[k].range_m, points[(k + 1) % n].range_m);  // whichever way it turns
  const double spacing_m = farther_m * std::fabs(sweep.angle_step_rad);
  if (norm(jump) <= std::max(kJumpM, kJumpSteps * spacing_m)) return true;
  const bool at_an_end = !sweep.all_round && (k == 0 || k + 2 >= n);
  return !at_an_end && goes_on_as(step_from(points, k + n - 1), jump) && goes_on_as(step_from(points, k + 1), jump);
}

constexpr int kFirst = 4;
constexpr double kJumpMps = 0.25, kJumpRadps = 0.3;           // 2 m/s^2 from one scan to the next at 8 Hz
constexpr Duration kSettlesWithin = std::chrono::seconds(1);  // by trial; 1.5 s is no better

}  // namespace

Sweep sweep_of(const LaserScan& scan) noexcept {
  const auto beams = static_cast<std::uint32_t>(std::min<std::size_t>(scan.beam_count, kMaxBeams));
  const double step = static_cast<double>(scan.angle_step_rad);
  const double past_a_turn = std::fabs(step) * beams - 2.0 * kPi;  // a step: the first direction is looked along twice
  const bool all_round = past_a_turn > -0.5 * std::fabs(step) && past_a_turn < 1.5 * std::fabs(step);
  const double sweep_s = std::clamp(to_seconds(scan.sweep), 0.0, kLongestSweepS);
  return {beams, step, all_round, sweep_s / std::max(1.0, beams - 1.0)};
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

void begin_at_a_jump(const Sweep& sweep, ScanPoints& points) noexcept {
  if (!sweep.all_round || points.empty() || !joined(points, points.size() - 1, sweep)) return;
  std::size_t k = 1;
  while (k < points.size() && joined(points, k - 1, sweep)) ++k;
  std::rotate(points.begin(), points.begin() + k, points.end());
}

void cut_at_jumps(const ScanPoints& points, const Sweep& sweep, Segments& out) noexcept {
  out.clear();
  for (std::uint32_t k = 0; k < points.size(); ++k) {
    if (k > 0 && joined(points, k - 1, sweep)) {
      out.back().last = k;
    } else {
      (void)out.push_back({k, k});  // never full
    }
  }
}

bool FirstScans::are_unreliable(const Twist2& twist, Time now) noexcept {
  if (scans_ < kFirst && ++scans_ > 1) {
    const bool jumped =
        std::fabs(twist.v_mps - last_.v_mps) > kJumpMps || std::fabs(twist.w_radps - last_.w_radps) > kJumpRadps;
    if (jumped) jumped_ = now;
  }
  last_ = twist;
  return jumped_ != kNever && now >= jumped_ && now - jumped_ < kSettlesWithin;
}

}  // namespace jaywalk
