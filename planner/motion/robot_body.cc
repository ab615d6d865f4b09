#include "planner/motion/robot_body.h"

#include <algorithm>
#include <iterator>
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

}  // namespace

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

SpeedZones::SpeedZones(std::span<const MapZone> zones, const RobotModel& model)
    : reach_m_(model.footprint.circumscribed_radius_m() + kZoneMargin_m), max_accel_mps2_(model.limits.max_accel_mps2) {
  std::copy_if(zones.begin(), zones.end(), std::back_inserter(zones_),
               [](const MapZone& zone) { return zone.kind == ZoneKind::kSpeed; });
}

ZoneSpeed SpeedZones::at(Vec2 robot) const noexcept {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  ZoneSpeed least{kAny, kAny};
  for (const MapZone& zone : zones_) {
    const double left_m = signed_distance(zone, robot) - reach_m_;
    if (left_m <= 0.0) least.here_mps = std::min(least.here_mps, zone.speed_mps);
    const double ahead_m = std::max(left_m - kSettled_m, 0.0);
    least.ahead_mps = std::min(least.ahead_mps, slowing_speed(zone.speed_mps, ahead_m, max_accel_mps2_));
  }
  return least;
}

}  // namespace jaywalk::motion
