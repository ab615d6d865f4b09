#include "hal/sim/simulation.h"

#include <optional>
#include <vector>

#include "hal/sim/sensors.h"
#include "hal/sim/world.h"

namespace jaywalk::sim {
namespace {

/// A device whose newest reading stays as it is while the world moves on.
template <class Device, class Reading>
class SimSource final : public Device {
 public:
  explicit SimSource(const Reading& newest) : newest_(newest) {}
  const Reading& latest() noexcept override {
    if (given_.sequence != newest_.sequence) given_ = newest_;
    return given_;
  }

 private:
  const Reading& newest_;
  Reading given_;
};

class SimPanel final : public OperatorPanel {
 public:
  SimPanel(const World& world, const Scenario& scenario, std::uint64_t seed)
      : world_(world),
        input_{.has_goal = !scenario.stick,
               .goal_in_map = scenario.goal,
               .goal_tolerance_m = scenario.goal_tolerance_m,
               .goal_heading_rad = scenario.goal_heading_rad,
               .goal_heading_tolerance_rad = scenario.goal_heading_tolerance_rad,
               .steers = scenario.stick.has_value()} {
    if (scenario.stick) stick_.emplace(*scenario.stick, scenario, seed);
  }
  OperatorInput latest() noexcept override {
    input_.stamp = world_.now();
    if (stick_) input_.stick = stick_->at(world_.truth());
    input_.emergency_stop = world_.fault_active(FaultKind::kEmergencyStop);
    return input_;
  }

 private:
  const World& world_;
  OperatorInput input_;  ///< of a stick's robot the goal is that of the person, and has_goal is false
  std::optional<ScriptedStick> stick_;
};

/// Segments as they are; discs as eight-sided outlines.
std::vector<WallSegment> drawn(const Walls& walls) {
  constexpr int kSides = 8;
  std::vector<WallSegment> lines(walls.segments().begin(), walls.segments().end());
  for (const Disc& disc : walls.discs()) {
    const auto corner = [&](int k) { return disc.centre + direction(2.0 * kPi * k / kSides) * disc.radius_m; };
    for (int k = 0; k < kSides; ++k) lines.push_back({corner(k), corner(k + 1)});
  }
  return lines;
}

}  // namespace

struct Simulation::State final : DriveBase, Clock {
  const Scenario scenario;
  const std::uint64_t seed;
  World world;
  Sensors sensors;
  std::vector<SimSource<LaserScanner, LaserScan>> lasers;
  SimPanel panel;
  SimSource<PoseSource, OutsideFix> pose_source{sensors.fix()};
  std::vector<WallSegment> drawn_walls;

  State(const Scenario& given, std::uint64_t random_seed)
      : scenario(given),
        seed(random_seed),
        world(scenario, seed),
        sensors(scenario, seed),
        panel(world, scenario, seed),
        drawn_walls(drawn(world.walls())) {
    for (std::size_t k = 0; k < scenario.model.lasers().size(); ++k) lasers.emplace_back(sensors.scan(k));
    sensors.sense(world);
  }

  WheelState latest() noexcept override { return sensors.wheels(); }
  void command(const WheelCommand& command) noexcept override { world.plant().command(command, world.now()); }
  Time now() noexcept override { return world.now(); }
  void sleep_until(Time wake) noexcept override {
    while (world.now() < wake) {
      world.step();
      sensors.sense(world);
    }
  }
};

Simulation::Simulation(const Scenario& scenario, std::uint64_t seed)
    : state_(std::make_unique<State>(scenario, seed)) {}
Simulation::~Simulation() = default;

Hal Simulation::hal() noexcept {
  State& s = *state_;
  Hal hal{s.lasers.front(), s, s.panel, s.pose_source, s};
  for (std::size_t k = 1; k < s.lasers.size(); ++k) (void)hal.other_lasers.push_back(&s.lasers[k]);
  return hal;
}

const Truth& Simulation::truth() const noexcept { return state_->world.truth(); }
void Simulation::begin_fault(FaultKind kind, double for_s) { state_->world.begin_fault(kind, for_s); }
bool Simulation::add_walker() { return state_->world.add_walker(state_->scenario, state_->seed); }
bool Simulation::remove_walker() noexcept { return state_->world.remove_walker(); }
double Simulation::static_shortest_path_m() const { return state_->world.free_grid().shortest_path_m(); }
std::span<const WallSegment> Simulation::walls() const noexcept { return state_->drawn_walls; }

std::string Simulation::mover_rule() {
  return "wandering: straight at constant speed; when a wall, another mover or the robot lies within 0.5 m ahead of "
         "its edge and within 45 degrees of its heading it stops, turns in place (1 rad/s unless the scenario says "
         "otherwise) to a random heading whose zone is free, and walks on; forced when the robot alone lies there. "
         "recorded: never reacts; forced when the robot lies within 0.4 m ahead of its edge and within 45 degrees. "
         "social: by the social force of Helbing and Molnar 1995 and HuNavSim's reactions; forced as recorded ones";
}

}  // namespace jaywalk::sim
