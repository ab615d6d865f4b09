#pragma once
// How the robot moves when it is told to: one formula for the roll-outs and for the wheels.
#include <cmath>

#include "planner/cell/cell.h"

namespace jaywalk::motion {

/// What the robot may do, SI.
struct MotionBounds {
  float speed = 0.0F, back = 0.0F;  ///< forward, and backward where its scanner does not look
  float turn = 0.0F, turn_accel = 0.0F;
  float accel = 0.0F, slowing = 0.0F;
  float jerk = 0.0F;
  float brake = 0.0F;  ///< as hard as the drives are proved to, without a limit of jerk
};

/// Where the robot is and how it moves, in the map.
struct RobotState {
  float x = 0.0F, y = 0.0F, heading = 0.0F;
  float v = 0.0F, w = 0.0F, accel = 0.0F;
  float braked = 0.0F;  ///< m/s2 that the brake took last, beside `accel`
};

struct Command {
  float v = 0.0F, w = 0.0F;
  bool brakes = false;  ///< where it slows down: as hard as it can
};

/// The same arc, within the bounds' speeds.
JAYWALK_CELL Command within(const MotionBounds& bounds, const Command& command) {
  const float most = command.v < 0.0F ? bounds.back : bounds.speed, size = std::fabs(command.v);
  if (size <= most) return command;
  const float share = most / size;
  return {command.v * share, command.w * share, command.brakes};
}

/// The side (1: left, -1: right) that a robot turns to at `w` rad/s; `last` while it turns to neither.
JAYWALK_CELL float turned_side(float w, float last) {
  constexpr float kLeast = 0.1F;  // rad/s, as a campaign's report counts (docs/how-to/campaigns.md)
  return w > kLeast ? 1.0F : w < -kLeast ? -1.0F : last;
}

/// How long the robot has not got on: since the time to the goal fell below the least that it had been so far.
struct StallState {
  float for_s = 0.0F;
  float least_to_go_s = 0.0F;
  bool is_alone = false;   ///< no pedestrian is about
  float wound_rad = 0.0F;  ///< net turn since then, left positive
  /// Time since this goal was given, less price::kWonBack times the fall of the time to go, s, 0 to price::kMostLostS.
  /// Unlike `for_s` it does not begin anew with each half second of progress.
  float lost_s = 0.0F;

  [[nodiscard]] JAYWALK_CELL bool gets_on(float to_go_s) const {
    constexpr float kFallsByS = 0.5F;
    return to_go_s < least_to_go_s - kFallsByS;
  }
};

/// The speed of `s`, `dt` seconds on the way to `target`, with bounded acceleration and jerk: the acceleration never
/// exceeds what jerk takes back to zero in the speed left.
JAYWALK_CELL void change_speed(RobotState& s, float target, const MotionBounds& bounds, float dt) {
  const float left = target - s.v, size = std::fabs(left);
  const bool slows = std::fabs(target) < std::fabs(s.v);
  const float step = bounds.jerk * dt;
  const float landing = step * (std::sqrt(0.25F + 2.0F * size / (step * dt)) - 0.5F);
  float wanted = slows ? bounds.slowing : bounds.accel;
  wanted = wanted < landing ? wanted : landing;
  wanted = wanted < size / dt ? wanted : size / dt;
  const float change = (left < 0.0F ? -wanted : wanted) - s.accel;
  s.accel += change > step ? step : change < -step ? -step : change;
  s.v += s.accel * dt;
  const bool passed = left > 0.0F ? s.v > target : s.v < target;
  const bool lands = std::fabs(s.accel) <= 1.01F * step;
  if ((passed && lands) || std::fabs(target - s.v) < 1e-6F) s.v = target;
}

/// The speed of `s`, `dt` seconds of braking to `target` later: the brake bites and is let go at once.
JAYWALK_CELL void brake_speed(RobotState& s, float target, const MotionBounds& bounds, float dt) {
  const float left = target - s.v, most = bounds.brake * dt;
  s.braked = (std::fabs(left) < most ? std::fabs(left) : most) / dt;
  s.v = std::fabs(left) > most ? s.v + (left < 0.0F ? -most : most) : target;
  s.accel = 0.0F;
}

/// Puts `s` where its speeds bring it in `dt` seconds from `from`: by the arc's middle heading.
JAYWALK_CELL void place_after(const RobotState& from, RobotState& s, float dt) {
  const cell::Heading middle = cell::heading_at(from.heading + 0.5F * s.w * dt);
  s.heading = from.heading + s.w * dt;
  s.x = from.x + s.v * middle.x * dt;
  s.y = from.y + s.v * middle.y * dt;
}

/// `dt` seconds on the way to a command: the speed by change_speed() or brake_speed(), the turn with bounded
/// acceleration. A command that stays is not overshot; one that comes while the robot speeds up past it is, unless it
/// brakes. To go the other way the speed comes to rest first.
JAYWALK_CELL RobotState moved(const RobotState& from, const Command& to, const MotionBounds& bounds, float dt) {
  RobotState s = from;
  const float target = to.v * s.v < 0.0F ? 0.0F : to.v;  // the supervisor holds it at rest in between
  s.braked = 0.0F;
  if (to.brakes && std::fabs(target) < std::fabs(s.v))
    brake_speed(s, target, bounds, dt);
  else
    change_speed(s, target, bounds, dt);
  const float turn_step = bounds.turn_accel * dt, turn_left = to.w - s.w;
  s.w += turn_left > turn_step ? turn_step : turn_left < -turn_step ? -turn_step : turn_left;
  place_after(from, s, dt);
  return s;
}

/// Way in which the robot comes to rest within the bounds of comfort, m: what it has of acceleration goes by their
/// jerk, then it slows down and lets go likewise.
JAYWALK_CELL float stopping_way(const RobotState& s, const MotionBounds& bounds) {
  const float speed = std::fabs(s.v), accel = s.v < 0.0F ? -s.accel : s.accel, j = bounds.jerk;
  const float top = speed + 0.5F * accel * accel / j, full = bounds.slowing * bounds.slowing / j;
  const float until = accel / j * (speed + accel * accel / (3.0F * j));
  const float after = top < full ? top * std::sqrt(top / j) : 0.5F * top * (top / bounds.slowing + bounds.slowing / j);
  return until + after;
}

/// Whether the robot, slowed from now on, comes to rest within `within_m` of the goal, less than `before_m` before the
/// place on its way that is nearest to it.
JAYWALK_CELL bool rests_near(const RobotState& s, float goal_x, float goal_y, float within_m, float before_m,
                             const MotionBounds& bounds) {
  const cell::Heading along = cell::heading_at(s.heading);
  const float way = s.v < 0.0F ? -stopping_way(s, bounds) : stopping_way(s, bounds);
  const float dx = goal_x - s.x - way * along.x, dy = goal_y - s.y - way * along.y;
  const float ahead = s.v < 0.0F ? -dx * along.x - dy * along.y : dx * along.x + dy * along.y;
  return dx * dx + dy * dy < within_m * within_m && (s.v == 0.0F || ahead < before_m);
}

}  // namespace jaywalk::motion
