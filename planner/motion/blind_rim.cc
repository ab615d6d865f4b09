#include "planner/motion/blind_rim.h"

#include <algorithm>
#include <cmath>

#include "hal/types/robot_model.h"

namespace jaywalk::motion {
namespace {

constexpr double kSpacing_m = 0.05;
constexpr float kUnwatchedMps = 0.29F;   // SupervisorConfig's 0.3, less what a tick may err
constexpr float kMostlyOutward = 0.5F;   // Watch's
constexpr int kHalvings = 8;             // of the turn looked for: to 0.005 rad/s
constexpr double kFieldEdge_rad = 0.01;  // a beam's share at the rim of the field of view

bool is_watched(const OfEach<LaserModel>& lasers, Vec2 in_robot) {
  for (const LaserModel& laser : lasers) {
    const Vec2 p = inverse(laser.robot_from_laser) * in_robot;
    if (laser.fov_rad >= 2.0 * kPi - 2.0 * kFieldEdge_rad ||
        std::fabs(std::atan2(p.y, p.x)) < 0.5 * laser.fov_rad - kFieldEdge_rad)
      return true;
  }
  return false;
}

}  // namespace

BlindRim::BlindRim(const Footprint& footprint, const OfEach<LaserModel>& lasers) {
  const double front = footprint.front_m, rear = -footprint.rear_m, half = footprint.half_width_m;
  const Vec2 corners[4] = {{front, half}, {rear, half}, {rear, -half}, {front, -half}};
  const Vec2 normals[4] = {{0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}, {1.0, 0.0}};  // of the side that begins there
  const auto add = [&](Vec2 p, Vec2 out) {
    if (is_watched(lasers, p + out * StopZoneRules<double>::kMargin_m)) return;
    points_.push_back(
        {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(out.x), static_cast<float>(out.y)});
    reach_m_ = std::max(reach_m_, static_cast<float>(norm(p)));
  };
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2 from = corners[k], to = corners[(k + 1) % 4];
    add(from, normals[k] + normals[(k + 3) % 4]);
    const int pieces = static_cast<int>(distance(from, to) / kSpacing_m) + 1;
    for (int n = 1; n < pieces; ++n) add(from + (to - from) * (static_cast<double>(n) / pieces), normals[k]);
  }
}

float BlindRim::too_fast(float v, float w) const noexcept {
  if (std::fabs(v) + std::fabs(w) * reach_m_ <= kUnwatchedMps) return 0.0F;
  float fastest2 = kUnwatchedMps * kUnwatchedMps;
  for (const Point& p : points_) {
    const float x = v - w * p.y, y = w * p.x, speed2 = x * x + y * y;
    if (speed2 <= fastest2) continue;
    const float out = std::max(x * p.out_x, y * p.out_y);
    if (out > 0.0F && out * out > kMostlyOutward * kMostlyOutward * speed2) fastest2 = speed2;
  }
  return std::sqrt(fastest2) - kUnwatchedMps;
}

Command BlindRim::slowed(const Command& command) const noexcept {
  const float over = too_fast(command.v, command.w);
  const float share = kUnwatchedMps / (kUnwatchedMps + over);
  return {share * command.v, share * command.w};
}

float BlindRim::turn_at(float v, float w) const noexcept {
  if (too_fast(v, w) <= 0.0F || too_fast(v, 0.0F) > 0.0F) return w;
  float most = 0.0F, over = w;
  for (int halving = 0; halving < kHalvings; ++halving) {
    const float middle = 0.5F * (most + over);
    (too_fast(v, middle) > 0.0F ? over : most) = middle;
  }
  return most;
}

}  // namespace jaywalk::motion
