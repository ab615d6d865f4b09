#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "hal/sim/random.h"
#include "hal/sim/walls.h"
#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"

namespace jaywalk::sim {

/// A planar laser: every beam at once, or one after another as it turns; Gaussian range noise, beams that get lost.
/// What lies beyond its range gives infinity; what is too near and a lost beam give 0 (LaserScan). Memory is taken at
/// construction.
class LaserSim {
 public:
  /// `index` tells apart the noise of several.
  LaserSim(const LaserModel& model, std::uint64_t seed, std::uint64_t index = 0);

  /// Writes the sweep from where the robot stands; `movers` are round. Keeps scan.sequence.
  void sweep(const Walls& walls, std::span<const Disc> movers, const Pose2& map_from_robot, Time now,
             LaserScan& scan) noexcept;

  /// From the first beam to the last of a scanner that turns.
  [[nodiscard]] Duration turn_takes() const noexcept;
  /// Begins a turn: forgets what was measured.
  void begin_turn(Time now) noexcept { began_ = now, measured_ = 0; }
  /// Measures the beams whose time has come, from where the robot stands now. With the last it writes the scan, stamped
  /// when the turn began, and returns true.
  bool turn(const Walls& walls, std::span<const Disc> movers, const Pose2& map_from_robot, Time now,
            LaserScan& scan) noexcept;

 private:
  void write(Time stamp, Duration sweep, LaserScan& scan) noexcept;
  void see_walls(const Walls& walls, const Pose2& map_from_laser) noexcept;
  void see(const Disc& mover, Vec2 laser_in_map) noexcept;
  [[nodiscard]] float measured(double range) noexcept;

  LaserModel model_;
  std::vector<Vec2> in_laser_;  ///< each beam's direction
  std::vector<Vec2> in_map_;
  std::vector<double> range_;  ///< true ranges of the sweep under way
  Time began_ = kNever;        ///< of a turn
  std::size_t measured_ = 0;   ///< beams of it
  Random noise_;
  Random loss_;
};

}  // namespace jaywalk::sim
