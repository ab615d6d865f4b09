#include "planner/paper/start_field.h"

#include <algorithm>

#include "hal/types/trig.h"

namespace jaywalk::paper {
std::vector<std::uint16_t> rate_table(std::int32_t max_side) {
  std::vector<std::uint16_t> table(static_cast<std::size_t>(4 * (max_side + 4)));
  for (std::size_t quarter = 0; quarter < table.size(); ++quarter) {
    const double width = static_cast<double>(quarter) / 4.0;
    const double cosh_rate = 2.0 - cos(kPi / (width + 1.0));
    const double rate = log(cosh_rate + std::sqrt(cosh_rate * cosh_rate - 1.0));
    table[quarter] = static_cast<std::uint16_t>(std::floor(rate / 2.0 * static_cast<double>(kCostsPerPsi) + 0.5));
  }
  return table;
}

/// A diagonal step costs no less than a straight one among the same rates.
template <class May, class Visit>
void StartGraph::for_each_step(std::int32_t n, const May& may, const Visit& visit) const noexcept {
  const field::CellNode* const node = &nodes_[static_cast<std::size_t>(n)];
  const std::uint32_t here = node->rate;
  const auto along = [&](std::int32_t away) {
    const field::CellNode there = node[away];
    const std::uint32_t step = straight_step(here, there.rate);
    if (there.rate != 0 && may(there.cost, step)) visit(n + away, step);
  };
  along(1), along(-1), along(width_), along(-width_);
  const auto across = [&](std::int32_t di, std::int32_t dj) {
    const field::CellNode there = node[di + dj];
    if (there.rate == 0 || !may(there.cost, straight_step(here, there.rate))) return;
    const std::uint32_t a = node[di].rate, b = node[dj].rate;
    if (a != 0 && b != 0) visit(n + di + dj, diagonal_step(here, there.rate, a, b));
  };
  across(1, width_), across(-1, width_), across(1, -width_), across(-1, -width_);
}

/// Two entries a cell: 1.3 of them are queued in all.
StartField::StartField(std::int32_t max_side)
    : table_(rate_table(max_side)), graph_(max_side), queue_(0, 2 * static_cast<std::size_t>(Grid{max_side}.cells())) {}

bool StartField::settle(Grid grid, std::int32_t goal, const float* clearance, float* psi) noexcept {
  const std::int32_t last = grid.side - 1;
  graph_.take_grid(grid);
  graph_.clear();
  for (std::int32_t j = 0; j <= last; ++j) {
    for (std::int32_t i = 0; i <= last; ++i) {
      const float* here = clearance + grid.at(i, j);
      if (*here <= 0.0F) continue;
      const float east = i < last ? here[1] : 0.0F, west = i > 0 ? here[-1] : 0.0F;
      const float north = j < last ? here[grid.side] : 0.0F, south = j > 0 ? here[-grid.side] : 0.0F;
      const float width = passage_width(*here, std::max(east, west), std::max(north, south));
      graph_.set_rate(graph_.at(i, j), table_[static_cast<std::size_t>(4.0F * width)]);
    }
  }
  queue_.clear();
  queue_.offer(graph_, graph_.at(goal % grid.side, goal / grid.side), 0);
  if (!queue_.settle(graph_)) return false;
  for (std::int32_t j = 0; j <= last; ++j) {
    for (std::int32_t i = 0; i <= last; ++i) {
      const std::int32_t n = graph_.at(i, j);
      psi[grid.at(i, j)] = graph_.rate(n) == 0 ? cell::kNotFree
                           : graph_.cost(n) == field::kNoWay
                               ? cell::kUnreachable
                               : static_cast<float>(graph_.cost(n)) * (1.0F / kCostsPerPsi);
    }
  }
  return true;
}

}  // namespace jaywalk::paper
