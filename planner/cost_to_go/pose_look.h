#pragma once
#include <cstdint>

#include "planner/cell/cell.h"
#include "planner/cost_to_go/pose_moves.h"

namespace jaywalk::field {

/// Where a body's outline has how much room, by nodes that know how far the nearest surface is: plain values. A pose
/// stands for the place in its cell, across its heading, at which the body has most room.
struct PoseLook {
  static constexpr std::int32_t kSides = 3;    ///< a cell's middle, to the left, to the right
  static constexpr std::int32_t kPerCell = 4;  ///< nodes
  static constexpr std::int32_t kMargin = 60;  ///< a body reaches 1.5 m from its axle at most
  static constexpr std::int32_t kNodes = PoseLattice::kSide * kPerCell + 2 * kMargin, kColumns = kNodes / kPerCell;

  const std::uint8_t* nodes;   ///< every fourth of a row side by side
  const std::int32_t* places;  ///< of the node of each heading's, side's and point's, for cell (0, 0)
  const std::uint8_t* radius;  ///< of each point: of a circle within the body; 0: of the outline
  std::int32_t points;
  std::uint8_t* room;  ///< by pose
  std::int8_t* shift;  ///< to the left

  JAYWALK_CELL static std::int8_t shift_of(std::int32_t side) {
    return static_cast<std::int8_t>(side == 2 ? -1 : side);
  }
  JAYWALK_CELL static std::uint8_t left(std::uint8_t node, std::uint8_t radius) {
    return static_cast<std::uint8_t>((node > radius ? node : radius) - radius);
  }

  /// Visits a pose: cells run fastest.
  JAYWALK_CELL void operator()(std::int32_t k) const {
    const std::int32_t i = k % PoseLattice::kSide, j = k / PoseLattice::kSide % PoseLattice::kSide,
                       heading = k / (PoseLattice::kSide * PoseLattice::kSide);
    const std::int32_t pose = PoseLattice::at(i, j, heading), cell = j * kPerCell * kColumns + i;
    for (std::int32_t side = 0; side < kSides; ++side) {
      const std::int32_t* at = places + (heading * kSides + side) * points;
      std::uint8_t least = 255;
      for (std::int32_t p = 0; p < points; ++p) {
        const std::uint8_t there = left(nodes[at[p] + cell], radius[p]);
        least = there < least ? there : least;
      }
      if (side > 0 && least <= room[pose]) continue;
      room[pose] = least, shift[pose] = shift_of(side);
    }
  }
};

}  // namespace jaywalk::field
