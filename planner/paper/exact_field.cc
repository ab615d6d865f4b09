#include <algorithm>
#include <limits>

#include "hal/types/trig.h"
#include "planner/paper/map_field.h"

namespace jaywalk::paper {
namespace {
constexpr std::int32_t kUnseen = -1;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Calls visit(n) for each of the cell's neighbours inside the grid.
template <class Visit>
void for_each_neighbour(Grid grid, std::int32_t c, const Visit& visit) {
  const std::int32_t i = c % grid.side, j = c / grid.side;
  if (i > 0) visit(c - 1);
  if (i < grid.side - 1) visit(c + 1);
  if (j > 0) visit(c - grid.side);
  if (j < grid.side - 1) visit(c + grid.side);
}

/// The cells that the goal can be reached from, nearest first, and the place of each among them.
struct Order {
  std::vector<std::int32_t> cells, place;

  Order(Grid grid, const std::uint8_t* free, std::int32_t goal)
      : place(static_cast<std::size_t>(grid.cells()), kUnseen) {
    add(goal);
    for (std::size_t k = 0; k < cells.size(); ++k) {
      for_each_neighbour(grid, cells[k], [&](std::int32_t n) {
        if (free[n] != 0 && at(n) == kUnseen) add(n);
      });
    }
  }
  [[nodiscard]] std::int32_t at(std::int32_t c) const { return place[static_cast<std::size_t>(c)]; }
  void add(std::int32_t c) {
    place[static_cast<std::size_t>(c)] = static_cast<std::int32_t>(cells.size());
    cells.push_back(c);
  }
  /// How far back in the order the farthest neighbour of any cell is.
  [[nodiscard]] std::int32_t band(Grid grid) const {
    std::int32_t most = 1;
    for (const std::int32_t c : cells) {
      for_each_neighbour(grid, c,
                         [&](std::int32_t n) { most = at(n) == kUnseen ? most : std::max(most, at(c) - at(n)); });
    }
    return most;
  }
};

/// A network of nodes in that order, each joined to some of the `band` before it and to the ground (u = 0). Only the
/// rows that elimination still works on carry conductances; what is eliminated keeps its own for the way back.
class Network {
 public:
  Network(Grid grid, const Order& order)
      : band_(static_cast<std::size_t>(order.band(grid))),
        joint_(order.cells.size() * band_, 0.0),
        ground_(order.cells.size(), 0.0) {
    for (std::size_t k = 0; k < ground_.size(); ++k) {
      std::int32_t walls = 4;
      for_each_neighbour(grid, order.cells[k], [&](std::int32_t n) {
        const std::int32_t place = order.at(n);
        if (place != kUnseen) --walls;
        if (place != kUnseen && place < static_cast<std::int32_t>(k)) joint(k, static_cast<std::size_t>(place)) = 1.0;
      });
      ground_[k] = walls;
    }
  }

  /// Star to mesh: takes node k out, joins those it was joined to. What is left of k is the share that each has in it.
  void eliminate(std::size_t k) {
    const std::size_t first = k > band_ ? k - band_ : 0;
    double sum = ground_[k];
    for (std::size_t n = first; n < k; ++n) sum += joint(k, n);
    for (std::size_t n = first; n < k; ++n) {
      if (joint(k, n) <= 0.0) continue;
      const double share = joint(k, n) / sum;
      // Rows run from the nearest node to the farthest: side by side in memory, so that vectors take them.
      double* const theirs = joint_.data() + n * band_;
      const double* const own = joint_.data() + k * band_ + (k - n);
      for (std::size_t a = 0; a < n - first; ++a) theirs[a] += share * own[a];
      ground_[n] += share * ground_[k];
    }
    for (std::size_t n = first; n < k; ++n) joint(k, n) /= sum;
  }

  /// psi of node k from those of the nodes before it.
  [[nodiscard]] double psi(std::size_t k, const std::vector<double>& before) const {
    const std::size_t first = k > band_ ? k - band_ : 0;
    double base = kInfinite;
    for (std::size_t n = first; n < k; ++n) {
      if (joint(k, n) > 0.0) base = std::min(base, before[n]);
    }
    double sum = 0.0;
    for (std::size_t n = first; n < k; ++n) {
      if (joint(k, n) > 0.0) sum += joint(k, n) * exp(base - before[n]);
    }
    return base - log(sum);
  }

 private:
  double& joint(std::size_t k, std::size_t before) { return joint_[k * band_ + (k - before - 1)]; }
  [[nodiscard]] double joint(std::size_t k, std::size_t before) const { return joint_[k * band_ + (k - before - 1)]; }

  std::size_t band_;
  std::vector<double> joint_, ground_;
};

}  // namespace

std::vector<double> exact_psi(Grid grid, const std::uint8_t* free, std::int32_t goal, double most) {
  const Order order(grid, free, goal);
  const double band = order.band(grid);
  if (static_cast<double>(order.cells.size()) * band * band / 2.0 > most) return {};
  Network network(grid, order);
  for (std::size_t k = order.cells.size() - 1; k > 0; --k) network.eliminate(k);
  std::vector<double> by_order(order.cells.size(), 0.0), by_cell(static_cast<std::size_t>(grid.cells()), kInfinite);
  for (std::size_t k = 1; k < by_order.size(); ++k) by_order[k] = network.psi(k, by_order);
  for (std::size_t k = 0; k < by_order.size(); ++k) by_cell[static_cast<std::size_t>(order.cells[k])] = by_order[k];
  return by_cell;
}

double share_of_best(Grid grid, const float* psi, const std::vector<double>& exact, std::int32_t goal) {
  std::int64_t joined = 0, best = 0;
  for (std::int32_t c = 0; c < grid.cells(); ++c) {
    if (!(exact[static_cast<std::size_t>(c)] < kInfinite) || c == goal) continue;
    std::int32_t chosen = c;
    double lowest = kInfinite;
    for_each_neighbour(grid, c, [&](std::int32_t n) {
      if (psi[n] < psi[chosen]) chosen = n;
      lowest = std::min(lowest, exact[static_cast<std::size_t>(n)]);
    });
    ++joined;
    if (chosen != c && exact[static_cast<std::size_t>(chosen)] <= lowest + 1e-6) ++best;
  }
  return joined == 0 ? 1.0 : static_cast<double>(best) / static_cast<double>(joined);
}

}  // namespace jaywalk::paper
