#include "planner/motion/robot_body.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planner/motion/twist_ramp.h"

namespace jaywalk::motion {
namespace {

constexpr double kJustBelow = 1.0 - 1e-6;                 ///< single precision must not round a limit up
constexpr float kMostTurn = 1.2F, kMostTurnAccel = 2.0F;  ///< comfort: a passenger's
constexpr float kSlowing = 0.65F;
constexpr float kMostJerk = 0.75F;  ///< SAFETY's 0.9 m/s3, measured behind the wheels' lag, over 0.1 s
constexpr float kBackMps = 0.3F;    ///< SAFETY: where the scanner does not look
constexpr double kOverSides_m = 0.02, kOverSidesAmongMovers_m = 0.06;

constexpr double kSettled_m = 0.1;  ///< before a zone begins the drives have the last of the ramp behind them

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

RobotBody robot_body(const Footprint& f, const MotionLimits& l, const OfEach<LaserModel>& lasers,
                     double comfort_distance_m) {
  RobotBody body;
  body.outline = BodyOutline::of(f);
  body.to_walls = BodyDiscs::covering(f, kOverSides_m);
  body.to_movers = BodyDiscs::covering(f, kOverSidesAmongMovers_m);
  body.rim_m = static_cast<float>(f.circumscribed_radius_m());
  body.comfort_distance_m = static_cast<float>(comfort_distance_m);
  body.blind = BlindRim(f, lasers);
  const auto front = static_cast<float>(f.front_m), rear = static_cast<float>(-f.rear_m),
             side = static_cast<float>(f.half_width_m), middle = 0.5F * (front + rear);
  body.rim = {{{front, side},
               {front, 0.0F},
               {front, -side},
               {middle, side},
               {middle, -side},
               {rear, side},
               {rear, 0.0F},
               {rear, -side}}};
  const auto at_most = [](double limit, float most) { return std::min(static_cast<float>(limit), most); };
  body.bounds = {.turn = at_most(l.max_turn_radps, kMostTurn),
                 .turn_accel = at_most(l.max_turn_accel_radps2, kMostTurnAccel),
                 .accel = static_cast<float>(l.max_accel_mps2),
                 .slowing = std::max(static_cast<float>(l.max_accel_mps2), at_most(l.brake_mps2, kSlowing)),
                 .jerk = at_most(l.max_jerk_mps3, kMostJerk),
                 .brake = static_cast<float>(l.brake_mps2)};
  limit_speed_of(body.bounds, l, l.max_speed_mps);
  return body;
}

void limit_speed_of(MotionBounds& bounds, const MotionLimits& limits, double most_mps) noexcept {
  const double most = std::min(limits.max_speed_mps, most_mps);
  bounds.speed = static_cast<float>(most * kJustBelow);
  bounds.back = std::min(static_cast<float>(most), kBackMps);
}

ZoneSpeed zone_speed(std::span<const MapZone> zones, const RobotModel& model, Vec2 robot) noexcept {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  const double reach_m = model.footprint.circumscribed_radius_m() + kZoneMargin_m;  // and what its pose may be off by
  ZoneSpeed least{kAny, kAny};
  for (const MapZone& zone : zones) {
    if (zone.kind != ZoneKind::kSpeed) continue;
    const double left_m = signed_distance(zone, robot) - reach_m;
    if (left_m <= 0.0) least.here_mps = std::min(least.here_mps, zone.speed_mps);
    const double ahead_m = std::max(left_m - kSettled_m, 0.0);
    least.ahead_mps = std::min(least.ahead_mps, slowing_speed(zone.speed_mps, ahead_m, model.limits.max_accel_mps2));
  }
  return least;
}

}  // namespace jaywalk::motion
