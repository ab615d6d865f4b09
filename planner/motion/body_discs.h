#pragma once
// A rectangular body as a row of discs that cover it: its distance to a surface in a few looks.
#include <array>
#include <cmath>

#include "hal/types/robot_model.h"
#include "planner/cell/circle.h"
#include "planner/cost_to_go/guide.h"

namespace jaywalk::motion {

/// Discs of one radius with their middles on the body's long axis. They reach beyond its sides by what the constructor
/// was told at most, so that what is clear of them is clear of the body.
struct BodyDiscs {
  static constexpr int kMost = 12;
  std::array<float, kMost> ahead{};  ///< of each middle, m from the axle
  float radius = 0.0F;
  int count = 0;

  /// As few discs as reach no more than `beyond_m` over the sides.
  static BodyDiscs covering(const Footprint& body, double beyond_m) {
    const double length = body.front_m + body.rear_m, w = body.half_width_m;
    BodyDiscs discs;
    for (discs.count = 1; discs.count < kMost; ++discs.count) {
      const double half = 0.5 * length / discs.count;
      if (std::sqrt(half * half + w * w) <= w + beyond_m) break;
    }
    const double half = 0.5 * length / discs.count;
    discs.radius = static_cast<float>(std::sqrt(half * half + w * w));
    for (int k = 0; k < discs.count; ++k) {
      discs.ahead[static_cast<std::size_t>(k)] = static_cast<float>(-body.rear_m + half * (2 * k + 1));
    }
    return discs;
  }

  /// From the body at (x, y), looking along `ahead_of`, to the nearest surface or keep-out zone, m; below 0 inside one.
  [[nodiscard]] JAYWALK_ANYWHERE float clearance(const Guide& guide, float x, float y,
                                                 const cell::Heading& along) const {
    float least = Guide::kFar_m;
    for (int k = 0; k < count; ++k) {
      const float s = ahead[static_cast<std::size_t>(k)];
      const float d = guide.room(x + s * along.x, y + s * along.y);
      least = d < least ? d : least;
    }
    return least - radius;
  }
};

}  // namespace jaywalk::motion
