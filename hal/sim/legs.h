#pragma once
#include <array>

#include "hal/maps/wall_map.h"
#include "hal/sim/simulation.h"

namespace jaywalk::sim {

/// The two legs of a walking pedestrian, as a laser at the height of the shins sees them. Feet stand on the ground in
/// turns, for a step each, and overtake each other at twice his speed; shins, a third of the way up to the hip, do two
/// thirds of that about his middle. Steps are the longer the faster he walks: length over rate is 0.0065 m per step a
/// minute (Sekiya and Nagasaki 1998). Below 1 m/s people's steps are longer than that (PMC5430280), which is left out.
/// A pedestrian that stops puts its feet side by side.
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

}  // namespace jaywalk::sim
