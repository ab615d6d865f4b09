#pragma once
#include "planner/cell/cell.h"

namespace jaywalk::cell {

// What a step of the start field costs, from half the costs (`rate`) of the cells that it touches. Integers, so that
// the dearest and the cheapest way are the same whatever the order.

/// Between two cells side by side.
JAYWALK_CELL std::uint32_t straight_step(std::uint32_t from, std::uint32_t to) { return from + to; }

/// Between two cells at a corner; `a` and `b` are the free ones beside both. Dearer than straight ahead by a quarter in
/// wide rooms and by more in narrow passages, where turning costs more: 5/4 w + w^2/16384, w a straight step of 4096 to
/// a unit of -ln u. Measured with exact_psi; so that estimates are rather too high than too low, since cycles correct
/// upwards by a factor of eight at most. Never so cheap that neither `a` nor `b` is lower than where the step leads,
/// from either end: descent by four neighbours arrives too.
JAYWALK_CELL std::uint32_t diagonal_step(std::uint32_t from, std::uint32_t to, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t straight = from + to, wanted = straight + straight / 4 + straight * straight / 16384;
  const std::uint32_t least = (a < b ? a : b) + (from > to ? from : to) + 1;
  return wanted > least ? wanted : least;
}

}  // namespace jaywalk::cell
