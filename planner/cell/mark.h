#pragma once
#include <cmath>

#include "planner/cell/cell.h"

namespace jaywalk::cell {

/// The Gaussian mark exp(-d^2 / 2 s^2) counts as occupied above exp(-1/2): one standard deviation.
/// A higher reach closes doorways that movers leave open; measured by success, not by principle.
inline constexpr float kMarkDeviations = 1.0F;

/// Distance from a mover's expected position within which cells count as occupied: its body, the
/// safety distance, and where the Gaussian of the prediction's variance (per axis) is above its
/// level, at most `most_spread`: a mark that fills the room forbids nothing useful.
JAYWALK_CELL float mark_radius(float body, float safety, float variance, float most_spread) {
  const float spread = kMarkDeviations * std::sqrt(variance);
  return body + safety + (spread < most_spread ? spread : most_spread);
}

JAYWALK_CELL bool within(float dx, float dy, float radius) { return dx * dx + dy * dy <= radius * radius; }

}  // namespace jaywalk::cell
