#pragma once
#include <cstddef>
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

/// An executor's memory for a grid's values by rows, with a spare row and a cell at either end: a stage may fetch
/// what lies beyond the border before it decides not to use it.
template <class T, class Executor>
[[nodiscard]] T* take_rows(Executor& executor, std::int32_t side) {
  const auto spare = static_cast<std::size_t>(side) + 1;
  return executor.template take<T>(static_cast<std::size_t>(Grid{side}.cells()) + 2 * spare) + spare;
}

}  // namespace jaywalk::field
