#include "planner/scan/self_mask.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

constexpr double kTurnRad = 0.1;
constexpr double kBodyM = 0.5;  // about a turn's middle: a pedestrian there is no wider, shoulders and all
constexpr double kOwnM = 0.3;   // about the axle's: nobody stands there, so that near it everything is asked
constexpr float kFarthestPartM = 1.0F;
constexpr float kSameM = 0.03F;   // a laser's noise at this distance, twice
constexpr double kSwaysM = 0.05;  // a mast, and the noise
constexpr int kMost = 20;         // headings remembered: what was taken off is forgotten after as many

/// The middle of the turn that takes the robot from one pose to the other, in its own frame at both.
Vec2 middle_of_turn(const Pose2& from, const Pose2& to) {
  const Pose2 step = inverse(from) * to;
  // c = step c: c = (I - R)^-1 t, and (I - R)^-1 = (1, -cot(w/2); cot(w/2), 1) / 2 for a turn by w.
  const Vec2 half = direction(0.5 * step.heading);
  const double cot = half.x / half.y;
  return {0.5 * (step.x - cot * step.y), 0.5 * (step.y + cot * step.x)};
}

}  // namespace

bool SelfMask::on_robot(std::size_t beam, double range_m) const noexcept {
  return agreed_[beam] >= kEnough && std::fabs(range_m - static_cast<double>(range_m_[beam])) < kSwaysM;
}

void SelfMask::learn(const LaserScan& scan, const Pose2& map_from_robot) noexcept {
  const std::size_t beams = std::min<std::size_t>(scan.beam_count, kMaxBeams);
  for (std::size_t b = 0; b < beams; ++b) measured_[b] = measured_[b] || scan.is_hit(b) || scan.found_nothing(b);
  const auto as_then = [&](const Pose2& asked) {
    return std::fabs(wrap_angle(map_from_robot.heading - asked.heading)) < kTurnRad;
  };
  if (std::any_of(asked_at_.begin(), asked_at_.end(), as_then)) return;
  const Vec2 middle = middle_of_turn(asked_at_[last_asked_], map_from_robot);
  last_asked_ = (last_asked_ + 1) % asked_at_.size();
  asked_at_[last_asked_] = map_from_robot;
  asked_ = std::min(asked_ + 1, std::uint32_t{kEnough});
  const bool on_the_spot = norm(middle) < kOwnM;
  const Transform2 robot_from_laser(robot_from_laser_);
  for (std::size_t b = 0; b < beams; ++b) {
    if (!scan.is_hit(b)) continue;  // proves nothing
    const float range = scan.range_m[b];
    const Vec2 there = robot_from_laser * (direction(scan.angle_rad(b)) * static_cast<double>(range));
    if (!on_the_spot && distance(there, middle) < kBodyM) continue;
    const bool same = range < kFarthestPartM && std::fabs(range - range_m_[b]) < kSameM;
    if (same) {
      agreed_[b] = static_cast<std::uint8_t>(std::min(agreed_[b] + 1, kMost));
    } else if (agreed_[b] > 0) {
      --agreed_[b];  // a mast sways; the robot does not lose it
    } else {
      range_m_[b] = range;
    }
  }
}

}  // namespace jaywalk
