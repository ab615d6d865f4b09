#pragma once
// Trajectories that a decision tries: along the way to the goal, and others.
#include "planner/motion/situation.h"
#include "planner/motion/trajectory_cost.h"

namespace jaywalk::motion {

/// Whether only the heading is left to be reached.
[[nodiscard]] bool turns_at_goal(const Situation& situation, const RobotState& robot) noexcept;
/// On the spot.
[[nodiscard]] Command turn_to(float heading, const RobotState& robot, const MotionBounds& bounds) noexcept;

/// Follows the way that the pose guide has from somewhere, gear by gear: it comes to rest where the gear changes, and
/// slows down where the outline has little room. Thread: any.
class WayPursuit {
 public:
  WayPursuit(const Situation& situation, const RobotState& from) noexcept;

  /// Whether the way has an end in sight that is not reached yet.
  [[nodiscard]] bool has_more(const RobotState& robot) noexcept;
  /// While has_more(): what to do next, no faster than `speed`.
  [[nodiscard]] Command command(const RobotState& robot, float speed) noexcept;

 private:
  [[nodiscard]] const WayPose& pose(std::int32_t k) const noexcept { return way_.poses[static_cast<std::size_t>(k)]; }
  void join_small_turns() noexcept;
  [[nodiscard]] bool is_passed(const RobotState& robot, const WayPose& pose) const noexcept;
  [[nodiscard]] Place look_ahead(const RobotState& robot) const noexcept;
  [[nodiscard]] float bend_to(Place target, const RobotState& robot) const noexcept;
  [[nodiscard]] float room_m() const noexcept;

  const Situation& s_;
  PoseWay way_;
  std::int32_t at_ = 0, end_ = 0;  ///< the next pose, and the last of its gear
};

/// The trajectories that a decision tries, by number: each a function of the situation and its number alone, so that
/// they can be made anywhere and in any order. Thread: any.
class TrajectoryProposals {
 public:
  /// `constant_mps` above 0: every one of them has that speed throughout.
  TrajectoryProposals(const Situation& situation, float constant_mps) : s_(situation), constant_(constant_mps) {}

  [[nodiscard]] int count() const;
  void make(int number, Trajectory& out) const noexcept;
  /// `base` with smooth noise; `round` and `number` name it.
  void perturb(const Trajectory& base, std::uint32_t decision, int round, int number, Trajectory& out) const noexcept;

  /// `base` with its turning averaged over `half` steps to either side, from how the robot turns now.
  void smooth(const Trajectory& base, int half, Trajectory& out) const noexcept;

 private:
  void follow_from(RobotState robot, int step, float speed, Trajectory& out) const noexcept;
  void follow_way(RobotState& robot, int& step, float speed, Trajectory& out) const noexcept;
  void drive_out(RobotState& robot, int from, int to, Command command, Trajectory& out) const noexcept;
  void arc(int number, Trajectory& out) const noexcept;
  void arc_then_follow(int number, Trajectory& out) const noexcept;
  void go_straight(int number, Trajectory& out) const noexcept;
  void brake(int number, Trajectory& out) const noexcept;
  [[nodiscard]] Command permitted(const Command& command) const noexcept;
  [[nodiscard]] Command pursuit(const RobotState& robot, float speed) const noexcept;
  [[nodiscard]] Command towards(float error_rad, float speed) const noexcept;

  const Situation& s_;
  float constant_;
};

/// What is left of a trajectory `by_s` seconds after its start, in between its steps, its last command held.
[[nodiscard]] Trajectory shifted(const Trajectory& trajectory, float by_s) noexcept;

}  // namespace jaywalk::motion
