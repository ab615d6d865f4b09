#pragma once
#include "planner/motion/situation.h"

namespace jaywalk::motion {

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

/// The trajectories that a decision tries, each a function of the situation alone. Thread: any.
class TrajectoryProposals {
 public:
  /// `constant_mps` above 0: every one of them has that speed throughout.
  TrajectoryProposals(const Situation& situation, float constant_mps) : s_(situation), constant_(constant_mps) {}

  /// Makes one after the other in `out`, and calls look(out) with each.
  template <class Look>
  void each(Trajectory& out, const Look& look) const;
  /// `base` with smooth noise; `round` and `number` name it.
  void perturb(const Trajectory& base, std::uint32_t decision, int round, int number, Trajectory& out) const noexcept;

  /// `base` with its turning averaged over `half` steps to either side, from how the robot turns now.
  void smooth(const Trajectory& base, int half, Trajectory& out) const noexcept;

 private:
  void hold_then_follow(const Command& command, int steps, float speed, Trajectory& out) const noexcept;
  void follow_then_hold(int steps, const Command& command, Trajectory& out) const noexcept;
  void follow_from(RobotState robot, int step, float speed, Trajectory& out) const noexcept;
  void follow_way(RobotState& robot, int& step, float speed, Trajectory& out) const noexcept;
  void drive_out(RobotState& robot, int from, int to, Command command, Trajectory& out) const noexcept;
  void go_straight(float heading, Trajectory& out) const noexcept;
  [[nodiscard]] Command permitted(const Command& command) const noexcept;
  [[nodiscard]] Command pursuit(const RobotState& robot, float speed) const noexcept;
  [[nodiscard]] Command towards(float error_rad, float speed) const noexcept;

  const Situation& s_;
  float constant_;
};

template <class Look>
void TrajectoryProposals::each(Trajectory& out, const Look& look) const {
  constexpr float kForward[] = {1.0F, 0.667F, 0.333F, 0.0F}, kBack[] = {0.5F, 1.0F};  // of the full speeds
  constexpr int kBends[] = {7, 14};                                                   // steps of an arc
  constexpr Command kStop{0.0F, 0.0F, true};
  const MotionBounds& b = s_.body.bounds;
  const float full = constant_ > 0.0F ? constant_ : b.speed;
  const auto tried = [&](Proposal proposal) { out.proposal = proposal, look(out); };
  const auto each_turn = [&](float v, const auto& make) {
    for (const float turn : {0.0F, -0.15F, 0.15F, -0.3F, 0.3F, -0.5F, 0.5F, -0.75F, 0.75F, -1.0F, 1.0F})
      make(permitted({v, turn * b.turn}));
  };
  const auto arcs = [&](float v) {
    each_turn(v, [&](Command arc) { out.commands.fill(arc), tried(v < 0.0F ? Proposal::kArcBack : Proposal::kArc); });
  };
  const auto bends = [&](Proposal proposal, float v, int steps) {
    each_turn(v, [&](Command arc) { hold_then_follow(arc, steps, full, out), tried(proposal); });
  };
  out.perturbed = false;
  if (constant_ > 0.0F) {
    hold_then_follow({}, 0, full, out), tried(Proposal::kFollow);
    arcs(full);
    for (const int steps : kBends) bends(Proposal::kArcThenFollow, full, steps);
    return;
  }
  for (const float share : {1.0F, 0.833F, 0.667F, 0.5F, 0.333F, 0.167F, 0.0F})
    hold_then_follow({}, 0, share * full, out), tried(Proposal::kFollow);
  for (const int steps : {8, 16, 24, 32}) hold_then_follow({}, steps, full, out), tried(Proposal::kWaitThenGo);
  for (const int steps : {6, 14, 22, 30}) follow_then_hold(steps, {}, out), tried(Proposal::kGoThenStop);
  for (const float share : kForward) arcs(share * full);
  for (const float share : kBack) arcs(-share * b.back);
  for (const float share : kForward)
    for (const int steps : kBends) bends(Proposal::kArcThenFollow, share * full, steps);
  for (const float share : kBack) bends(Proposal::kBackThenFollow, -share * b.back, kBends[0]);
  for (int n = 0; n < 12; ++n)
    go_straight(s_.start.heading + 2.0F * cell::kPiF * static_cast<float>(n) / 12.0F, out),
        tried(Proposal::kGoStraight);
  for (const int steps : {kSteps, 8, 16, 24, 32, 40})
    hold_then_follow(kStop, steps, full, out), tried(Proposal::kBrake);
  for (const int steps : {3, 6, 10}) follow_then_hold(steps, kStop, out), tried(Proposal::kBrake);
}

/// What is left of a trajectory `by_s` seconds after its start, in between its steps, its last command held.
[[nodiscard]] Trajectory shifted(const Trajectory& trajectory, float by_s) noexcept;

}  // namespace jaywalk::motion
