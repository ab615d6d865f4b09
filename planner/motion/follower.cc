#include "planner/motion/follower.h"

#include <algorithm>
#include <cmath>

#include "planner/motion/passing_speed.h"
#include "planner/motion/pursuit.h"

namespace jaywalk {
namespace {

constexpr double kStopWithin = 1.0 / 3.0;  // of the tolerance: close enough to stand still

}  // namespace

FollowerInput follower_input(const motion::World& world, const motion::Intent& intent) noexcept {
  return {.path = world.plan.path,
          .map_from_robot = world.map_from_robot,
          .goal_in_map = world.input.goal_in_map,
          .has_goal = intent.kind == motion::Intent::Kind::kGoal,
          .tracks = world.perceived.tracks,
          .standing = world.perceived.standing,
          .most_speed_mps = intent.most_mps,
          .permitted_before = world.driven};
}

Follower::Follower(const FollowerConfig& config)
    : config_(config),
      speed_choice_{.robot = config.robot,
                    .stands_at_worst = config.stands_at_worst,
                    .max_speed_mps = config.limits.max_speed_mps,
                    .max_accel_mps2 = config.limits.max_accel_mps2},
      ramp_(config.limits) {}

Twist2 Follower::ramped(const Twist2& target, const FollowerInput& input) noexcept {
  ramp_.follow(input.permitted_before);
  return ramp_.toward(target, config_.tick_s);
}

Twist2 Follower::braking_hard(const FollowerInput& input) noexcept {
  const Twist2& before = input.permitted_before;
  ramp_.follow(before);
  // The wheels lie within the body's sides: turning on the spot they go no faster than those.
  const double rim_mps = std::fabs(before.w_radps) * config_.robot.footprint.half_width_m;
  const double speed = std::max(std::fabs(before.v_mps), rim_mps);
  if (speed < 1e-9) return {};
  const double share = std::max(0.0, 1.0 - config_.limits.brake_mps2 * config_.tick_s / speed);
  return {before.v_mps * share, before.w_radps * share};
}

bool Follower::is_under_way(const FollowerInput& input) const noexcept {
  if (input.path.empty() || !input.has_goal) return false;
  const double to_goal_m = distance(input.map_from_robot.position(), input.goal_in_map);
  return config_.constant_speed || !(to_goal_m < config_.goal_tolerance_m * kStopWithin);
}

Twist2 Follower::along_path(const FollowerInput& input, double most_body_mps) noexcept {
  const double cruise = config_.constant_speed && input.has_goal ? config_.limits.max_speed_mps : 0.0;
  if (!is_under_way(input)) return ramped({cruise, 0.0}, input);
  const double v_now = std::max(input.permitted_before.v_mps, 0.0);
  const Steering steering = pursue(input.path, input.map_from_robot, v_now);
  if (steering.turns_first()) return ramped({cruise, steering.turn_radps(config_.limits.max_turn_radps)}, input);
  const double v = cruise > 0.0 ? cruise : speed_for(input, steering.curvature_per_m, most_body_mps);
  return ramped({v, steering.circle_radps(std::max(v, v_now), config_.limits.max_turn_radps)}, input);
}

Twist2 Follower::turning(GoalTurn& turn, const FollowerInput& input) noexcept {
  if (input.path.empty() || !input.has_goal) return to_rest(input);
  ManoeuvreDrive& drive = turn.manoeuvre();
  return drive.active() ? along(drive, input) : ramped(turn.command(input.map_from_robot), input);
}

/// Slower, or not at all, where a pedestrian is about to come by, or stands.
Twist2 Follower::along(ManoeuvreDrive& drive, const FollowerInput& input) noexcept {
  const Twist2 twist = drive.command(input.map_from_robot);
  const double among = among_people(drive.way(), input) / config_.limits.max_speed_mps;
  const double share = std::min({1.0, among, input.most_speed_mps / std::max(std::fabs(twist.v_mps), 1e-9)});
  return ramped({twist.v_mps * share, twist.w_radps * share}, input);
}

/// Lets walking pedestrians pass, and goes slowly by standing ones.
double Follower::among_people(const Way& way, const FollowerInput& input) const noexcept {
  const double v = std::fabs(input.permitted_before.v_mps);
  return std::min(choose_speed(way, input.map_from_robot, v, input.tracks, speed_choice_),
                  passing_speed(way, input.map_from_robot, input.standing, input.tracks, speed_choice_));
}

double Follower::speed_for(const FollowerInput& input, double curvature_per_m, double most_body_mps) const noexcept {
  const Vec2 robot = input.map_from_robot.position();
  const double in_curve = curve_speed(curvature_per_m, config_.limits.max_turn_radps);
  const double arrival_speed = slowing_speed(0.0, distance(robot, input.goal_in_map), config_.limits.max_accel_mps2);
  return std::min({config_.limits.max_speed_mps, input.most_speed_mps, in_curve, most_body_mps, arrival_speed,
                   among_people({.places = input.path}, input)});
}

}  // namespace jaywalk
