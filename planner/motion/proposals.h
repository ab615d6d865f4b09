#pragma once
#include "planner/motion/situation.h"

namespace jaywalk::motion {

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
