#include "planner/motion/follower.h"

#include <algorithm>
#include <cmath>

#include "planner/motion/passing_speed.h"

namespace jaywalk {
namespace {

constexpr double kStopWithin = 1.0 / 3.0;  // of the tolerance: close enough to stand still

}  // namespace

Follower::Follower(const FollowerConfig& config)
    : config_(config),
      speed_choice_{.robot = config.robot,
                    .stands_at_worst = config.stands_at_worst,
                    .max_speed_mps = config.limits.max_speed_mps,
                    .max_accel_mps2 = config.limits.max_accel_mps2},
      ramp_(config.limits) {}

Twist2 Follower::twist(const FollowerInput& input) noexcept {
  ramp_.follow(input.permitted_before);
  const bool turns = input.turn != nullptr && input.turn->active();  // then the guide does not look
  if (!turns && input.guide != nullptr && input.guide->brakes_hard()) return braked_hard(input.permitted_before);
  return ramp_.toward(wish(input), config_.tick_s);
}

/// As hard as the drives were proved to, on the same arc; comfort is for who is not about to touch somebody.
Twist2 Follower::braked_hard(const Twist2& before) const noexcept {
  // The wheels lie within the body's sides: turning on the spot they go no faster than those.
  const double rim_mps = std::fabs(before.w_radps) * config_.robot.footprint.half_width_m;
  const double speed = std::max(std::fabs(before.v_mps), rim_mps);
  if (speed < 1e-9) return {};
  const double share = std::max(0.0, 1.0 - config_.limits.brake_mps2 * config_.tick_s / speed);
  return {before.v_mps * share, before.w_radps * share};
}

Twist2 Follower::wish(const FollowerInput& input) noexcept {
  const double cruise = config_.constant_speed && input.has_goal ? config_.limits.max_speed_mps : 0.0;
  if (input.path.empty() || !input.has_goal) return {cruise, 0.0};
  if (input.turn != nullptr && input.turn->active()) return at_goal(input);
  const Vec2 robot = input.map_from_robot.position();
  if (cruise == 0.0 && distance(robot, input.goal_in_map) < config_.goal_tolerance_m * kStopWithin) return {};

  if (input.guide != nullptr && input.guide->manoeuvre().active()) {
    return manoeuvre(input, input.guide->manoeuvre());
  }
  if (input.guide != nullptr && input.guide->most_speed_mps() == 0.0) return {};
  const double v_now = std::max(input.permitted_before.v_mps, 0.0);
  const Steering steering = pursue(input.path, input.map_from_robot, v_now);
  if (steering.turns_first()) return {cruise, steering.turn_radps(config_.limits.max_turn_radps)};
  const double v = cruise > 0.0 ? cruise : speed_for(input, steering.curvature_per_m);
  return {v, steering.circle_radps(std::max(v, v_now), config_.limits.max_turn_radps)};
}

Twist2 Follower::at_goal(const FollowerInput& input) const noexcept {
  ManoeuvreDrive& drive = input.turn->manoeuvre();
  return drive.active() ? manoeuvre(input, drive) : input.turn->wish(input.map_from_robot);
}

/// Slower, or not at all, where somebody is about to come by, or stands.
Twist2 Follower::manoeuvre(const FollowerInput& input, ManoeuvreDrive& drive) const noexcept {
  const Twist2 twist = drive.wish(input.map_from_robot);
  const double among = among_people(drive.way(), input) / config_.limits.max_speed_mps;
  const double share = std::min({1.0, among, input.most_speed_mps / std::max(std::fabs(twist.v_mps), 1e-9)});
  return {twist.v_mps * share, twist.w_radps * share};
}

/// Lets those pass who walk, and goes slowly by those who stand.
double Follower::among_people(const Way& way, const FollowerInput& input) const noexcept {
  const double v = std::fabs(input.permitted_before.v_mps);
  return std::min(choose_speed(way, input.map_from_robot, v, input.tracks, speed_choice_),
                  passing_speed(way, input.map_from_robot, input.standing, input.tracks, speed_choice_));
}

double Follower::speed_for(const FollowerInput& input, double curvature_per_m) const noexcept {
  const Vec2 robot = input.map_from_robot.position();
  const double in_curve = curve_speed(curvature_per_m, config_.limits.max_turn_radps);
  const double for_body = input.guide != nullptr ? input.guide->most_speed_mps() : in_curve;
  const double arrival_speed = slowing_speed(0.0, distance(robot, input.goal_in_map), config_.limits.max_accel_mps2);
  return std::min({config_.limits.max_speed_mps, input.most_speed_mps, in_curve, for_body, arrival_speed,
                   among_people({.places = input.path}, input)});
}

}  // namespace jaywalk
