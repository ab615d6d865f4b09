#pragma once
#include "planner/motion/situation.h"

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

}  // namespace jaywalk::motion
