#pragma once
#include "planner/cell/cell.h"

namespace jaywalk::cell {

// What a step of the start field costs, from half the costs (`rate`) of the cells that it touches. Integers, so that
// the dearest and the cheapest way are the same whatever the order.

/// Between two cells side by side.
JAYWALK_CELL std::uint32_t straight_step(std::uint32_t from, std::uint32_t to) { return from + to; }

/// Between two cells at a corner; `a` and `b` are the free ones beside both. A quarter dearer than straight ahead: by
/// that much -ln u rises along diagonals of rooms and through turns (between 1, in wide ones, and the square root of 2;
/// measured with exact_psi). Never so cheap that the better of `a` and `b` is not lower than where the step leads:
/// descent by four neighbours arrives too.
JAYWALK_CELL std::uint32_t diagonal_step(std::uint32_t from, std::uint32_t to, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t straight = from + to, wanted = straight + straight / 4;
  const std::uint32_t least = (a < b ? a : b) + (from > to ? from : to) + 1;
  return wanted > least ? wanted : least;
}

}  // namespace jaywalk::cell
