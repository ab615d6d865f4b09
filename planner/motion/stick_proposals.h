#pragma once
// What a stick asks for, trajectories that come near to it, and how near they come.
#include <array>

#include "hal/types/geometry.h"
#include "hal/types/operator_input.h"
#include "planner/motion/robot_motion.h"
#include "planner/motion/trajectory.h"

namespace jaywalk::motion {

/// The stick counts for 3 s: longer than it takes to steer clear, sooner than a person asks for something else. By the
/// end of 5 s every trajectory is at rest, so that what is driven can always be ended without touching anything.
inline constexpr int kFollowedSteps = 30, kStickSteps = 50;
/// A radian that the robot looks aside is as far off as so many metres: the lever of a seat or a front.
inline constexpr float kTurnArm_m = 0.25F;

/// The stick as a twist: its full way is the robot's fastest within `bounds`. Of a stick that is no number: none.
[[nodiscard]] Command stick_command(const Stick& stick, const MotionBounds& bounds) noexcept;

/// A tick of slowing down to rest, on the arc that the robot is on.
[[nodiscard]] RobotState slowed(const RobotState& from, const MotionBounds& bounds, float dt) noexcept;

/// What the stick asks for, rolled out as if nothing were in the way.
struct StickRollout {
  Command command;
  std::array<RobotState, kFollowedSteps> states{};
};
[[nodiscard]] StickRollout roll_out_stick(const RobotState& start, const Command& command,
                                          const MotionBounds& bounds) noexcept;

/// How far off the stick's roll-out a trajectory is, in seconds at full speed: its distance from the place there at
/// the same time, and the radians between the two, averaged over 3 s, times 2. To stand in place of full speed costs
/// about as many seconds as the stick counts for. `states`: of each step, kFollowedSteps at least.
[[nodiscard]] float seconds_off(const StickRollout& asked, const RobotState* states,
                                const MotionBounds& bounds) noexcept;

/// One way of nearly obeying: a share of what is asked for, turned aside for some steps, then back, then as asked; then
/// to rest. With no share of the turn it goes straight on: a hand that trembles asks for no circle.
struct StickShape {
  float share = 1.0F;                                ///< of the speed asked for, 0 to 1
  float turn_share = 1.0F;                           ///< of the turn asked for, 0 to 1
  float aside = 0.0F;                                ///< rad/s more than asked
  float aside_steps = 0.0F;                          ///< for so many steps
  float back = 0.0F;                                 ///< and for this share of them as much less
  float steps = static_cast<float>(kFollowedSteps);  ///< until it slows down to rest
};
/// It never drives faster than asked, nor the other way.
void make(const StickShape& shape, const Command& asked, const RobotState& start, const MotionBounds& bounds,
          Trajectory& out) noexcept;
/// Those that each decision tries first; what is asked for itself is number 0.
[[nodiscard]] int shape_count() noexcept;
[[nodiscard]] StickShape shape_at(int number, const MotionBounds& bounds) noexcept;
/// `shape` with noise; decision, round and number name it.
[[nodiscard]] StickShape perturbed(const StickShape& shape, std::uint32_t decision, int round, int number,
                                   const MotionBounds& bounds) noexcept;

}  // namespace jaywalk::motion
