// Whole drives with what the emulated device computes, a round robot's and a wheelchair's: the processor's commands,
// tick by tick, also where the device is lost under way.
#include <algorithm>
#include <cmath>

#include "firmware/control_loop.h"
#include "firmware/recording/recorder.h"
#include "hal/sim/simulation.h"
#include "planner/cost_to_go/fallback_planner.h"
#include "tests/cuda/cuda_rig.h"

using namespace jaywalk;
using namespace jaywalk::test;
using emulated::device;
using emulated::Fault;

namespace {

/// A scenario in the loop, with one planner or the other.
class Drive {
 public:
  Drive(const char* name, PlanMode mode, bool on_device) : scenario_(loaded(name, mode)), simulation_(scenario_, 3) {
    setup_.model = scenario_.model;
    setup_.mode = mode;
    setup_.start = scenario_.start;
    setup_.goal = scenario_.goal;
    if (mode == PlanMode::kPaper) {
      setup_.make_motion = paper::make_motion;
      const paper::PaperConfig config{setup_.planner(), setup_.mover_radius_m()};
      planner_ = paper::make_cpu_paper_planner(config);
      if (on_device) planner_ = std::make_unique<FallbackPlanner>(cuda_paper_planner(config), std::move(planner_));
    } else {
      planner_ = make_cpu_planner(setup_.planner());
      if (on_device) planner_ = std::make_unique<FallbackPlanner>(cuda_planner(setup_.planner()), std::move(planner_));
    }
    loop_ = std::make_unique<ControlLoop>(setup_, simulation_.hal(), *planner_, recorder_);
  }

  const TickRecord& tick() {
    recorder_.drain();
    simulation_.hal().clock.sleep_until(due_ += setup_.tick());
    return loop_->tick(due_);
  }
  [[nodiscard]] std::string backend() const { return planner_->backend(); }
  [[nodiscard]] Vec2 place() const { return simulation_.truth().map_from_robot.position(); }
  [[nodiscard]] double gone_m() const { return distance(place(), setup_.start.position()); }

 private:
  static sim::Scenario loaded(const char* name, PlanMode mode) {
    sim::Scenario scenario = sim::load_scenario(std::string(JAYWALK_SCENARIOS) + "/" + name + ".toml");
    scenario.pose_source.enabled = mode == PlanMode::kPaper;
    return scenario;
  }

  sim::Scenario scenario_;
  sim::Simulation simulation_;
  ControlSetup setup_;
  Recorder recorder_{{}};
  std::unique_ptr<Planner> planner_;
  std::unique_ptr<ControlLoop> loop_;
  Time due_{};
};

/// Drives both for so many ticks; the device is lost at one of them, or never. The most that commands differ, rad/s.
double check_drive(const char* scenario, PlanMode mode, int ticks, int lost_at, Fault fault = Fault::kNone) {
  device().power_on({.seed = 5});
  double most_apart = 0.0;
  Drive cpu(scenario, mode, false), gpu(scenario, mode, true);
  for (int k = 0; k < ticks; ++k) {
    if (k == lost_at) device().order(fault, 2);
    const TickRecord &a = cpu.tick(), &b = gpu.tick();
    most_apart = std::max({most_apart, std::fabs(a.command.left_radps - b.command.left_radps),
                           std::fabs(a.command.right_radps - b.command.right_radps)});
  }
  CHECK(device().counts.launches > 0);
  CHECK(cpu.gone_m() > 0.1);
  CHECK(distance(cpu.place(), gpu.place()) < 1e-3);
  CHECK((gpu.backend() == "cuda") == (lost_at < 0));
  return most_apart;
}

}  // namespace

TEST_CASE("emulated: a round robot and a wheelchair drive by what the device computes as by the processor", "[drive]") {
  CHECK(check_drive("crossing", PlanMode::kFull, 100, -1) == 0);
  CHECK(check_drive("door", PlanMode::kFull, 60, -1) == 0);
}

TEST_CASE("emulated: a device that is lost under way is not felt: the same commands, tick by tick", "[drive]") {
  CHECK(check_drive("door", PlanMode::kFull, 70, 45, Fault::kBroken) == 0);
  // The processor's potential begins anew where the device's had improved from plan to plan.
  CHECK(check_drive("map1_16", PlanMode::kPaper, 100, 60, Fault::kBroken) < 0.01);
}

TEST_CASE("emulated at length: a kernel that hangs under way is not felt, and longer drives are the same",
          "[.large][drive]") {
  CHECK(check_drive("door", PlanMode::kFull, 70, 45, Fault::kHangs) == 0);
  CHECK(check_drive("door", PlanMode::kFull, 600, -1) == 0);
  CHECK(check_drive("crossing", PlanMode::kFull, 600, -1) == 0);
}
