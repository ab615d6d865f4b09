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
  /// Calls for heap memory within so many ticks; `each` looks at every one after it was counted.
  std::uint64_t heap_calls(int ticks, const std::function<void(const TickRecord&)>& each = {});
  /// Ticks until `seconds` have passed or `until` says so; true when it did.
  bool drive(double seconds, const std::function<bool(const TickRecord&)>& until = {});
  /// Ticks until the goal is 0.3 m away or something is touched; true at the goal, where nothing was touched.
  bool arrives(double limit_s, const std::function<void(const TickRecord&)>& each = {});

  [[nodiscard]] const sim::Truth& truth() const { return simulation_->truth(); }
  [[nodiscard]] const ControlSetup& setup() const { return setup_; }
  [[nodiscard]] const ControlLoop& loop() const { return *loop_; }
  [[nodiscard]] Recorder& recorder() { return *recorder_; }
  [[nodiscard]] Planner& planner() { return *planner_.planner; }
  [[nodiscard]] double to_goal_m() const;
  /// From where the robot was believed in a tick to where it is.
  [[nodiscard]] double off_m(const TickRecord& t) const;

 private:
  void sleep();

  ControlSetup setup_;
  std::unique_ptr<sim::Simulation> simulation_;
  ChosenPlanner planner_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<ControlLoop> loop_;
  Time due_{};
};

/// The drive "crossing" without movers, with a fault that by default begins when the robot is under way.
inline SimulatedDrive drive_with(sim::FaultKind kind, double at_s = 5.0, double for_s = 3.0) {
  return {"crossing", 1, [&](sim::Scenario& scenario) {
            scenario.wanderers.clear();
            scenario.faults = {{.at_s = at_s, .for_s = for_s, .kind = kind}};
          }};
}

}  // namespace jaywalk
