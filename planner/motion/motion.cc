#include "planner/motion/motion.h"

#include "planner/motion/goal_rollouts.h"
#include "planner/motion/stick_rollouts.h"

namespace jaywalk::motion {
namespace {

/// A motion to goals beside a stick: whichever the intent names drives, and the other keeps account.
class SteeredMotion final : public Motion {
 public:
  explicit SteeredMotion(const MotionSetup& setup) : to_goal_(setup), by_stick_(setup) {}

  void observe(const World& world, const Intent& intent) noexcept override {
    steered_ = intent.kind == Intent::Kind::kStick;
    to_goal_.observe(world, intent);
    by_stick_.observe(world, intent);
  }
  [[nodiscard]] Twist2 command(const World& world, const Intent& intent) noexcept override {
    return steered_ ? by_stick_.command(world, intent) : to_goal_.command(world, intent);
  }
  void decide(const World& world, const Intent& intent) noexcept override {
    to_goal_.decide(world, intent);
    by_stick_.decide(world, intent);
  }
  [[nodiscard]] MotionStatus status() const noexcept override {
    MotionStatus status = to_goal_.status();
    if (!steered_) return status;
    status.rests_on = by_stick_.status().rests_on;
    status.stick_asks = by_stick_.status().stick_asks;
    return status;
  }
  [[nodiscard]] PlanRequest request(const World& world) const noexcept override { return to_goal_.request(world); }
  [[nodiscard]] Duration plan_every() const noexcept override { return to_goal_.plan_every(); }
  [[nodiscard]] const GoalRollouts* rollouts() const noexcept override { return to_goal_.rollouts(); }

 private:
  GoalRollouts to_goal_;
  StickRollouts by_stick_;
  bool steered_ = false;
};

}  // namespace

std::unique_ptr<Motion> make_motion(const MotionSetup& setup) {
  if (setup.steering == StickUse::kNone) return std::make_unique<GoalRollouts>(setup);
  return std::make_unique<SteeredMotion>(setup);
}

}  // namespace jaywalk::motion
