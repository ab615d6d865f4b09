#pragma once
// The paper's movers: straight ahead at constant speed; they turn in place only when something is near ahead.
#include <cstdint>
#include <span>
#include <vector>

#include "hal/sim/free_grid.h"
#include "hal/sim/random.h"
#include "hal/sim/simulation.h"
#include "hal/sim/walls.h"
#include "hal/sim/zone.h"

namespace jaywalk::sim {

/// All wandering movers of a scenario. When a wall, another mover or the robot lies in a mover's zone (kWanderZone), it
/// stops, turns in place to a random heading whose zone is free, and walks again. It is forced when the robot, and
/// neither wall nor mover, made it turn.
class Wanderers {
 public:
  /// Places them at random where `grid` is reachable. Throws StartupError when there is no room. `walls` outlives this.
  Wanderers(const Scenario& scenario, const Walls& walls, const FreeGrid& grid, std::uint64_t seed);

  /// Moves all on by `step_s`. `others` are movers that do not wander.
  void step(double step_s, const RobotBody& robot, std::span<const MoverTruth> others) noexcept;

  [[nodiscard]] std::span<const MoverTruth> movers() const noexcept { return movers_; }
  /// How often a mover was forced.
  [[nodiscard]] std::uint32_t forced() const noexcept { return forced_; }
  /// True when in the last step a mover ran into the robot.
  [[nodiscard]] bool bumped_robot() const noexcept { return bumped_robot_; }

 private:
  enum class Activity : std::uint8_t { kWalking, kChoosing, kTurning };
  enum class Blocker : std::uint8_t { kNothing, kRobot, kOther };
  struct Mind {
    Activity activity = Activity::kWalking;
    double new_heading = 0.0;
    double speed_mps, turn_rate_radps, spontaneous_turns_hz;
    Random random;
  };
  struct Surroundings {
    const RobotBody& robot;
    std::span<const MoverTruth> others;
  };

  void place(const WanderSpec& spec, const Scenario& scenario, const FreeGrid& grid, std::uint64_t seed,
             Random& random);
  [[nodiscard]] bool has_room(Vec2 p, double radius_m, const Scenario& scenario, const FreeGrid& grid) const;
  [[nodiscard]] Blocker ahead(std::size_t self, double heading, const Surroundings& near) const noexcept;
  [[nodiscard]] Blocker touched(std::size_t self, Vec2 next, const Surroundings& near) const noexcept;
  void walk(std::size_t self, double step_s, const Surroundings& near) noexcept;
  void choose(std::size_t self, const Surroundings& near) noexcept;
  void turn(std::size_t self, double step_s) noexcept;
  void halt(std::size_t self, Blocker blocker) noexcept;

  const Walls& walls_;
  std::vector<MoverTruth> movers_;
  std::vector<Mind> minds_;
  std::uint32_t forced_ = 0;
  bool bumped_robot_ = false;
};

}  // namespace jaywalk::sim
