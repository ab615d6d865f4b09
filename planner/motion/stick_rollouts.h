#pragma once
#include "planner/motion/motion.h"
#include "planner/motion/near_returns.h"
#include "planner/motion/rollout_motion.h"

namespace jaywalk::motion {

/// The stick as a twist: its full way is the robot's fastest within `bounds`. Of a stick that is no number: none.
[[nodiscard]] Command stick_command(const Stick& stick, const MotionBounds& bounds) noexcept;

/// The stick's command, rolled out.
[[nodiscard]] StickRollout roll_out_stick(const RobotState& start, const Command& command,
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
/// Calls look(shape) with those that each decision tries first; what is asked for itself comes first.
template <class Look>
void each_shape(const MotionBounds& bounds, const Look& look) {
  look(StickShape{});
  for (const float steps : {0.0F, 3.0F, 6.0F, 10.0F, 15.0F}) look(StickShape{.steps = steps});
  for (const float share : {0.667F, 0.333F}) look(StickShape{.share = share});
  for (const float share : {1.0F, 0.667F, 0.333F})
    for (const float aside : {0.12F, -0.12F, 0.25F, -0.25F, 0.45F, -0.45F, 0.7F, -0.7F, 1.0F, -1.0F})
      for (const float steps : {4.0F, 8.0F, 14.0F, 22.0F})
        for (const float back : {0.0F, 1.0F})
          for (const float turn_share : {1.0F, 0.0F})
            look(StickShape{share, turn_share, aside * bounds.turn, steps, back});
}
/// `shape` with noise; decision, round and number name it.
[[nodiscard]] StickShape perturbed(const StickShape& shape, std::uint32_t decision, int round, int number,
                                   const MotionBounds& bounds) noexcept;

/// Roll-outs near to what a stick asks for, past what stands near the robot, where distance from that is a cost
/// like others. Any outline; no goal and no plan. A stick in the middle brings the robot to rest.
///
/// StickUse::kByHand: the stick's twist itself, within the comfort limits; the supervisor alone keeps it safe.
class StickRollouts final : public RolloutMotion {
 public:
  explicit StickRollouts(const MotionSetup& setup);

  void observe(const World& world, const Intent& intent) noexcept override;

 private:
  [[nodiscard]] const Guide& ground_before(const World&) noexcept override { return ground_.guide(); }
  [[nodiscard]] const Guide& ground(const World& world) noexcept override;
  [[nodiscard]] bool is_to_decide(const World& world, const Intent& intent, const Guide& ground) noexcept override;
  void choose(const World& world, const Guide& ground) noexcept override;
  [[nodiscard]] Next next(const World& world, const Intent& intent, const RobotState& now) noexcept override;

  [[nodiscard]] bool is_assisted() const noexcept { return setup_.steering == StickUse::kShared; }

  LocalGround ground_;
  Time seen_ = kNever;  ///< stamp of the last scan, decided on or not
  Command asked_;       ///< to be decided on
};

}  // namespace jaywalk::motion
