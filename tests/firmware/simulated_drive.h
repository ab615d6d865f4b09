#pragma once
#include <functional>
#include <memory>
#include <string>

#include "firmware/backends.h"
#include "firmware/control_loop.h"
#include "firmware/recording/recorder.h"
#include "hal/sim/simulation.h"

namespace jaywalk {

/// A scenario and the controller that drives in it, a tick at a time, for tests.
class SimulatedDrive {
 public:
  /// `edit` may change the scenario (add a fault, move the goal) before the world is built.
  using Edit = std::function<void(sim::Scenario&)>;
  SimulatedDrive(const std::string& scenario, std::uint64_t seed, const Edit& edit = {},
                 PlanMode mode = PlanMode::kFull, const std::string& recording = "",
                 const std::function<void(ControlSetup&)>& edit_setup = {});

  const TickRecord& tick();
  /// Sleeps until the next tick is due without ticking: what an allocation guard must not see.
  void sleep();
  const TickRecord& tick_now() noexcept { return loop_->tick(due_); }
  /// Ticks until `seconds` have passed or `until` says so; true when it did.
  bool drive(double seconds, const std::function<bool(const TickRecord&)>& until = {});

  [[nodiscard]] const sim::Truth& truth() const { return simulation_->truth(); }
  [[nodiscard]] const ControlSetup& setup() const { return setup_; }
  [[nodiscard]] const ControlLoop& loop() const { return *loop_; }
  [[nodiscard]] Recorder& recorder() { return *recorder_; }
  [[nodiscard]] double to_goal_m() const;

 private:
  ControlSetup setup_;
  std::unique_ptr<sim::Simulation> simulation_;
  ChosenPlanner planner_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<ControlLoop> loop_;
  Time due_{};
};

}  // namespace jaywalk
