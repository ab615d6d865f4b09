#pragma once
// The fixed-rate loop. One tick: sense, estimate, plan, act, record.
#include <cstdint>
#include <memory>
#include <vector>

#include "firmware/control_setup.h"
#include "firmware/estimator.h"
#include "firmware/recording/recorder.h"
#include "firmware/safety/beam_filter.h"
#include "firmware/safety/latency.h"
#include "firmware/safety/supervisor.h"
#include "hal/hal.h"
#include "planner/cost_to_go/planner.h"
#include "planner/motion/motion.h"
#include "planner/motion/robot_body.h"
#include "planner/motion/twist_ramp.h"

namespace jaywalk {

/// Owns the controller's parts; the devices, the planner and the recorder are lent and outlive it.
/// The constructor allocates; tick() never does, never throws and never waits. Thread: the loop's.
class ControlLoop {
 public:
  ControlLoop(const ControlSetup& setup, Hal hal, Planner& planner, Recorder& recorder);

  /// Lives through one tick; call once a period with the clock's time. Returns the tick's record, valid until the next.
  const TickRecord& tick(Time now) noexcept;

  [[nodiscard]] const ControlSetup& setup() const noexcept { return setup_; }
  [[nodiscard]] const Estimator& estimator() const noexcept { return estimator_; }
  [[nodiscard]] const Tracker& tracker() const noexcept { return estimator_.tracker(); }
  [[nodiscard]] const Plan& plan() const noexcept { return *plan_; }
  [[nodiscard]] const motion::Motion& motion() const noexcept { return *motion_; }
  [[nodiscard]] Mode mode() const noexcept { return supervisor_.mode(); }
  /// At the goal, on the way to the heading wanted there.
  [[nodiscard]] bool turns_at_goal() const noexcept { return motion_->status().turns_at_goal; }

 private:
  void read_devices(TickRecord& t) noexcept;
  void take_plan(TickRecord& t) noexcept;
  /// What motion wants.
  void ask(TickRecord& t) noexcept;
  /// What the supervisor makes of it.
  void permit(TickRecord& t) noexcept;
  void send(TickRecord& t) noexcept;
  /// With a new scan or plan: how to move from the next tick on, and what to plan next.
  void think_on(TickRecord& t, bool new_scan) noexcept;
  [[nodiscard]] bool is_steered(const TickRecord& t) const noexcept;
  [[nodiscard]] motion::Intent intent(const TickRecord& t) const noexcept;
  [[nodiscard]] motion::World world(const TickRecord& t) const noexcept;
  /// At that scan, its scanner's newest.
  [[nodiscard]] Pose2 map_from_laser(const LaserScan& scan) const noexcept;

  ControlSetup setup_;
  Hal hal_;
  Planner& planner_;
  Recorder& recorder_;
  std::vector<BeamFilter> beam_filters_;  ///< of each scanner
  motion::SpeedZones speed_zones_;
  motion::ZoneSpeed zone_speed_{};  ///< this tick's
  Estimator estimator_;
  std::unique_ptr<motion::Motion> motion_;  ///< never null
  Latency latency_;
  KnownWalls known_walls_;
  Supervisor supervisor_;
  DiffDrive diff_drive_;
  const Plan* plan_;                                    ///< what collect() last answered, never null
  Time asked_ = kNever;                                 ///< when a plan was asked for last
  Twist2 driven_;                                       ///< what the wheels were last asked for
  WheelCommand sent_;                                   ///< and what that was for the drive
  std::uint32_t plan_noted_ = 0, plan_decided_on_ = 0;  ///< their sequences
};

}  // namespace jaywalk
