#include "planner/field/nearest_cell.h"

#include <algorithm>

namespace jaywalk::field {

Flood::Flood(std::int32_t max_cells)
    : filled_(static_cast<std::size_t>(max_cells)), queue_(static_cast<std::size_t>(max_cells)) {}

void Flood::fill(Grid grid, const float* clearance, std::int32_t start) noexcept {
  std::fill_n(filled_.begin(), grid.cells(), std::uint8_t{0});
  touches_border_ = false;
  std::size_t head = 0, tail = 0;
  const auto enter = [&](std::int32_t c) {
    if (filled_[static_cast<std::size_t>(c)] != 0 || clearance[c] <= 0.0F) return;
    filled_[static_cast<std::size_t>(c)] = 1;
    queue_[tail++] = c;
  };
  enter(start);
  while (head < tail) {
    const std::int32_t c = queue_[head++];
    const std::int32_t i = c % grid.side, j = c / grid.side;
    touches_border_ |= i == 0 || j == 0 || i == grid.side - 1 || j == grid.side - 1;
    if (i > 0) enter(c - 1);
    if (i < grid.side - 1) enter(c + 1);
    if (j > 0) enter(c - grid.side);
    if (j < grid.side - 1) enter(c + grid.side);
  }
}

}  // namespace jaywalk::field
