#include "tests/firmware/simulated_drive.h"

#include "apps/rivals/paper_mode.h"
#include "tests/support/allocation_guard.h"

namespace jaywalk {

SimulatedDrive::SimulatedDrive(const std::string& name, std::uint64_t seed, const Edit& edit, PlanMode mode,
                               const std::string& recording, const std::function<void(ControlSetup&)>& edit_setup) {
  sim::Scenario scenario = sim::load_scenario(std::string(JAYWALK_SCENARIOS) + "/" + name + ".toml");
  scenario.pose_source.enabled = mode == PlanMode::kPaper;
  if (edit) edit(scenario);
  setup_.model = scenario.model;
  setup_.mode = mode;
  setup_.steering = scenario.stick ? scenario.stick->steering : StickUse::kNone;
  setup_.backend = Backend::kCpu;
  setup_.start = scenario.start;
  setup_.goal = scenario.goal;
  setup_.zones = scenario.zones;
  equip(setup_);
  if (edit_setup) edit_setup(setup_);
  simulation_ = std::make_unique<sim::Simulation>(scenario, seed);
  planner_ = make_planner(setup_);
  recorder_ = std::make_unique<Recorder>(RecorderConfig{.file = recording, .setup = to_text(setup_)});
  loop_ = std::make_unique<ControlLoop>(setup_, simulation_->hal(), *planner_.planner, *recorder_);
}

void SimulatedDrive::sleep() {
  recorder_->drain();
  due_ += setup_.tick();
  simulation_->hal().clock.sleep_until(due_);
}

const TickRecord& SimulatedDrive::tick() {
  sleep();
  return loop_->tick(due_);
}

std::uint64_t SimulatedDrive::heap_calls(int ticks, const std::function<void(const TickRecord&)>& each) {
  std::uint64_t calls = 0;
  for (int k = 0; k < ticks; ++k) {
    sleep();
    const AllocationGuard guard;
    const TickRecord& t = loop_->tick(due_);
    calls += guard.calls();
    if (each) each(t);
  }
  return calls;
}

bool SimulatedDrive::drive(double seconds, const std::function<bool(const TickRecord&)>& until) {
  for (const Time end = due_ + duration_from_seconds(seconds); due_ < end;) {
    const TickRecord& t = tick();
    if (until && until(t)) return true;
  }
  return false;
}

bool SimulatedDrive::arrives(double limit_s, const std::function<void(const TickRecord&)>& each) {
  const bool ended = drive(limit_s, [&](const TickRecord& t) {
    if (each) each(t);
    return to_goal_m() < 0.3 || truth().contacts > 0;
  });
  return ended && truth().contacts == 0;
}

double SimulatedDrive::off_m(const TickRecord& t) const {
  return distance(t.pose.map_from_robot.position(), truth().map_from_robot.position());
}

double SimulatedDrive::to_goal_m() const { return distance(truth().map_from_robot.position(), setup_.goal); }

}  // namespace jaywalk
