#pragma once
// What happens: robot, movers and walls in small fixed steps, and the truth about them.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/maps/wall_map.h"
#include "hal/sim/free_grid.h"
#include "hal/sim/movers.h"
#include "hal/sim/plant.h"
#include "hal/sim/simulation.h"
#include "hal/sim/social_walkers.h"

namespace jaywalk::sim {

/// The two legs of a walking pedestrian, as a laser at the height of the shins sees them. Feet stand in turns, for a
/// step each; shins, a third of the way up to the hip, do two thirds of their way about the middle. A step's length
/// over rate is 0.0065 m per step a minute (Sekiya and Nagasaki 1998); longer steps below 1 m/s (PMC5430280) are left
/// out.
class Legs {
 public:
  /// Goes on by `step_s` as the walker does.
  void walk(const MoverTruth& walker, double step_s) noexcept;
  /// In the map: left, right. Their middle is the walker's position.
  [[nodiscard]] std::array<Disc, 2> of(const MoverTruth& walker) const noexcept;

 private:
  double steps_ = 0.0;   ///< taken
  double step_m_ = 0.0;  ///< from foot to foot
};

/// The plant moves every step, movers every tenth.
inline constexpr Duration kWorldStep{2'000'000};
inline constexpr int kStepsAMove = 10;
inline constexpr Duration kMoverStep = kWorldStep * kStepsAMove;

class World {
 public:
  /// Throws StartupError for an unreadable map or recording, a start or goal in a wall or far off the map, no room for
  /// the movers.
  World(const Scenario& scenario, std::uint64_t seed);

  // Changes to an endless world, as Simulation's, between two steps.
  void begin_fault(FaultKind kind, double for_s) {
    faults_.push_back({.at_s = to_seconds(truth_.now), .for_s = for_s, .kind = kind, .way = {1.0, 0.0, 1.0}});
  }
  /// The robot's pose stands in for the scenario's start, so that kRoomToRobot (movers.cc) holds from where it is now.
  [[nodiscard]] bool add_walker(Scenario scenario, std::uint64_t seed) {
    scenario.start = plant_.map_from_robot();
    legs_.emplace_back();
    return wanderers_.add({scenario, walls_, grid_}, seed, static_cast<std::uint32_t>(legs_.size()), movers_);
  }
  [[nodiscard]] bool remove_walker() noexcept { return wanderers_.remove(); }

  /// Moves on by kWorldStep.
  void step() noexcept;

  [[nodiscard]] Time now() const noexcept { return truth_.now; }
  [[nodiscard]] Plant& plant() noexcept { return plant_; }
  [[nodiscard]] const Walls& walls() const noexcept { return walls_; }
  [[nodiscard]] const FreeGrid& free_grid() const noexcept { return grid_; }
  /// What a laser sees of the movers that are there.
  [[nodiscard]] std::span<const Disc> movers_seen() const noexcept { return seen_; }
  [[nodiscard]] const Truth& truth() const noexcept { return truth_; }
  [[nodiscard]] std::span<const FaultSpec> faults() const noexcept { return faults_; }
  /// Whether such a fault is there now: any, or one of `scanner`, counted from 0.
  [[nodiscard]] bool fault_active(FaultKind kind, std::optional<std::size_t> scanner = {}) const noexcept {
    return std::any_of(faults_.begin(), faults_.end(), [&](const FaultSpec& fault) {
      return fault.kind == kind && (!scanner || fault.is_of(*scanner)) && fault.active(to_seconds(truth_.now));
    });
  }

 private:
  [[nodiscard]] RobotBody body() const noexcept { return {footprint_, plant_.map_from_robot()}; }
  [[nodiscard]] double gap_to(std::span<const MoverTruth> movers) const noexcept {
    double nearest = kInfinity;
    const RobotBody robot = body();
    for (const MoverTruth& m : movers) nearest = std::min(nearest, robot.gap({m.position, m.radius_m}));
    return nearest;
  }
  void connect_plant() noexcept;
  /// Moves a carried robot by the part of its way that falls into this step.
  void carry_robot() noexcept;
  void keep_out_of_solids(const Pose2& before) noexcept;
  /// Gap (m) to the nearest mover that stops the robot.
  [[nodiscard]] double gap_to_solid_mover() const noexcept {
    return std::min(gap_to(wanderers_.movers()), gap_to(social_.movers()));
  }
  void gather_movers() noexcept {
    movers_.assign(wanderers_.movers().begin(), wanderers_.movers().end());
    movers_.insert(movers_.end(), recorded_.movers().begin(), recorded_.movers().end());
    movers_.insert(movers_.end(), social_.movers().begin(), social_.movers().end());
  }
  void move_movers() noexcept;
  void see_movers() noexcept;
  void judge_gaps() noexcept;
  void measure_nearness() noexcept;
  void touch() noexcept;
  /// The scenario itself, once its start and goal are known to be free and on the map.
  [[nodiscard]] const Scenario& with_free_places(const Scenario& scenario) const;

  std::vector<FaultSpec> faults_;
  Footprint footprint_;
  Walls walls_;
  FreeGrid grid_;
  Plant plant_;
  Wanderers wanderers_;
  RecordedMovers recorded_;
  SocialWalkers social_;
  std::vector<MoverTruth> movers_;  ///< wandering, recorded, social
  std::vector<Legs> legs_;          ///< by the movers' ids, which begin at 1
  std::vector<Disc> seen_;
  Truth truth_;
  std::int64_t steps_ = 0;
  double slack_m_ = 0.0;  ///< nothing can touch the robot before its outline has moved this far
  bool touching_ = false;
  double rim_speed_ = 0.0;  ///< at the last move of the movers
};

}  // namespace jaywalk::sim
