#pragma once
// The fixed-rate loop. One tick: sense, estimate, plan, act, record.
#include <cstdint>
#include <memory>
#include <utility>

#include "firmware/control_setup.h"
#include "firmware/estimator.h"
#include "firmware/recording/recorder.h"
#include "firmware/safety/latency.h"
#include "firmware/safety/supervisor.h"
#include "hal/hal.h"
#include "planner/baseline/baseline.h"
#include "planner/motion/diff_drive.h"
#include "planner/motion/follower.h"
#include "planner/motion/motion_planner.h"
#include "planner/motion/shared_control.h"
#include "planner/motion/speed_zones.h"
#include "planner/planner.h"

namespace jaywalk {

/// Owns the controller's parts; the devices, the planner and the recorder are lent and outlive it.
/// The constructor allocates; tick() never does, never throws and never waits. Thread: the loop's.
class ControlLoop {
 public:
  ControlLoop(const ControlSetup& setup, Hal hal, Planner& planner, Recorder& recorder);

  /// Lives through one tick; call once a period with the clock's time. Returns the tick's record, valid until the next.
  const TickRecord& tick(Time now) noexcept;

  [[nodiscard]] const Tracker& tracker() const noexcept { return estimator_.tracker(); }
  [[nodiscard]] const Plan& plan() const noexcept { return *plan_; }
  /// Null for a long body, and in mode paper.
  [[nodiscard]] const motion::MotionPlanner* motion() const noexcept { return motion_.get(); }
  [[nodiscard]] Mode mode() const noexcept { return supervisor_.mode(); }
  /// At the goal, on the way to the heading wanted there.
  [[nodiscard]] bool turns_at_goal() const noexcept { return turn_ && turn_->active(); }

 private:
  void note_plan(TickRecord& t) noexcept;
  /// There is a goal, and wishes count.
  [[nodiscard]] bool goal_for_motion(const TickRecord& t) const noexcept;
  [[nodiscard]] FollowerInput follower_input(const TickRecord& t) const noexcept;
  /// With a new plan, and after the wheels have their command: is there room for the body?
  void look(const TickRecord& t) noexcept;
  /// What is wished for is to keep to speed zones by itself.
  void limit_wishes(double most_mps) noexcept;
  /// Who decides on motion wishes.
  [[nodiscard]] Twist2 motion_twist(const TickRecord& t) noexcept;
  /// With a new scan, and after the wheels have their command: how to move from the next tick on.
  void decide(const TickRecord& t) noexcept;
  [[nodiscard]] bool drives_by_motion() const noexcept { return motion_ != nullptr && !turns_at_goal(); }
  /// A person steers, and this robot is made for it.
  [[nodiscard]] bool is_steered(const TickRecord& t) const noexcept { return t.input.steers && shared_ != nullptr; }
  /// The stick, while wishes count.
  [[nodiscard]] Stick stick_for_motion(const TickRecord& t) const noexcept;
  [[nodiscard]] motion::Seen seen(const TickRecord& t) const noexcept;
  [[nodiscard]] PlanRequest request(const TickRecord& t) const noexcept;

  ControlSetup setup_;
  Hal hal_;
  Planner& planner_;
  Recorder& recorder_;
  std::shared_ptr<const KeepOutField> keep_out_;  ///< null: no such zones
  motion::SpeedZones speed_zones_;
  motion::ZoneSpeed zone_speed_{};  ///< this tick's
  Estimator estimator_;
  Follower follower_;
  std::unique_ptr<motion::MotionPlanner> motion_;  ///< null for a long body, and in mode paper
  std::unique_ptr<motion::SharedControl> shared_;  ///< null where no stick steers
  std::unique_ptr<baseline::BaselinePlanner>
      baseline_;                           ///< null but in comparisons; then it wishes in place of motion_
  std::unique_ptr<FootprintGuide> guide_;  ///< null for a body that is nearly round
  std::unique_ptr<GoalTurn> turn_;         ///< null for a robot that keeps its speed
  Latency latency_;
  Supervisor supervisor_;
  DiffDrive diff_drive_;
  const Plan* plan_;                                   ///< what collect() last answered, never null
  Time asked_ = kNever;                                ///< when a plan was asked for last
  Time good_plan_stamp_ = kNever;                      ///< of the last that has a path
  Twist2 driven_;                                      ///< what the wheels were last asked for
  WheelCommand sent_;                                  ///< and what that was for the drive
  std::uint32_t plan_noted_ = 0, plan_looked_at_ = 0;  ///< their sequences
};

}  // namespace jaywalk
