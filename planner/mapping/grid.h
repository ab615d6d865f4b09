#pragma once
#include <cstdint>

#include "planner/cell/cell.h"

namespace jaywalk::field {

/// A square of cells, numbered row by row from the lowest y.
struct Grid {
  std::int32_t side = 0;

  [[nodiscard]] JAYWALK_CELL std::int32_t cells() const { return side * side; }
  [[nodiscard]] JAYWALK_CELL std::int32_t at(std::int32_t i, std::int32_t j) const { return j * side + i; }
  [[nodiscard]] JAYWALK_CELL bool holds(std::int32_t i, std::int32_t j) const {
    return i >= 0 && j >= 0 && i < side && j < side;
  }
};

}  // namespace jaywalk::field
