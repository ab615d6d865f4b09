#pragma once
// The simulated robot in its world, behind the HAL; one seed decides it. Time stands still until the controller sleeps.
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "hal/hal.h"
#include "hal/maps/wall_map.h"
#include "hal/sim/scenario.h"
#include "hal/types/social_measures.h"

namespace jaywalk::sim {

struct MoverTruth {
  std::uint32_t id = 0;
  Vec2 position{};
  Vec2 velocity{};
  double heading = 0.0;
  double radius_m = 0.0;
  bool on_legs = false;  ///< what the laser sees of it (Legs); all else takes it for round
  bool forced = false;   ///< true from the moment the robot made it turn until it walks again
};

/// State of the world for the report. The controller never sees it.
struct Truth {
  Time now = kNever;
  Pose2 map_from_robot;
  Twist2 twist;
  double accel_mps2 = 0.0;  ///< forward, of the plant
  std::span<const MoverTruth> movers;
  double clearance_m = 0.0;           ///< footprint to the nearest wall or mover; 0 in contact
  double mover_clearance_m = 0.0;     ///< footprint to the nearest mover; +inf without movers
  std::uint32_t contacts = 0;         ///< episodes of touching so far
  std::uint32_t contacts_caused = 0;  ///< those begun while any point of the outline moved faster than 0.05 m/s
  std::uint32_t forced_movers = 0;    ///< so far
  SocialMeasures social;
};

class Simulation {
 public:
  /// Throws StartupError for a world that cannot be (World).
  Simulation(const Scenario& scenario, std::uint64_t seed);
  ~Simulation();

  [[nodiscard]] Hal hal() noexcept;  ///< clock starts at zero
  [[nodiscard]] const Truth& truth() const noexcept;

  // Changes to an endless world (jaywalk sim --endless), between two ticks.

  /// With FaultSpec's defaults; kCarried moves the robot 1 m ahead and turns it by 1 rad.
  void begin_fault(FaultKind kind, double for_s);
  /// Adds a wandering mover of the scenario's first kind, 2 m or more from the robot. False where there is no room.
  [[nodiscard]] bool add_walker();
  /// Removes the newest wandering mover. False where there is none.
  [[nodiscard]] bool remove_walker() noexcept;

  /// Length (m) of the shortest path of the footprint's inscribed circle among the walls alone; infinity without one.
  [[nodiscard]] double static_shortest_path_m() const;
  [[nodiscard]] std::span<const WallSegment> walls() const noexcept;
  /// The wandering rule's geometry in words, for summary.json.
  [[nodiscard]] static std::string mover_rule();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace jaywalk::sim
