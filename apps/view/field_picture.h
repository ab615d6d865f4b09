#pragma once
#include <cstdint>

#include "hal/types/fixed_vector.h"
#include "planner/cost_to_go/planner.h"

namespace jaywalk::view {

inline constexpr std::int32_t kMostFieldSide = 128;

/// The potential, thinned to at most kMostFieldSide cells a side, a byte a cell, row by row from the lowest y: 0 at the
/// goal to 126 farthest, 127 more where nothing was ever seen, 254 without a way to the goal, 255 not free. Memory of a
/// fixed size.
struct FieldPicture {
  double low_x_m = 0.0, low_y_m = 0.0, cell_m = 0.0;  ///< in the map
  std::int32_t width = 0;
  FixedVector<std::uint8_t, static_cast<std::size_t>(kMostFieldSide) * kMostFieldSide> cells;
};

/// Allocates nothing. Thread: any that may look at the field.
void draw(FieldPicture& into, const FieldView& field, const EvidenceMap& seen) noexcept;

}  // namespace jaywalk::view
