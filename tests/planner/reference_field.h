#pragma once
// The harmonic function in double precision, for comparing directions: no code of the solver's.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "planner/cell/cell.h"
#include "planner/field/grid.h"

namespace jaywalk::test {

/// -ln(1 - phi) in double precision: Gauss-Seidel on u = exp(-guess) v, cells from the lowest guess to the highest and
/// back, which carries levels down the longest corridor in one sweep; after a hundred, when no level is far off any
/// more, over-relaxed by `over` (1 to 2; wide rooms need 1.9, corridors 1). `most` sweeps there and back.
inline std::vector<double> reference_psi(const field::Grid& grid, const float* guess, std::int32_t goal, int most,
                                         double over) {
  struct Unknown {
    std::int32_t cell;
    double coupling[4];
  };
  const auto n = static_cast<std::size_t>(grid.cells());
  const std::int32_t step[4] = {1, -1, grid.side, -grid.side};
  std::vector<double> psi(guess, guess + n), v(n, 0.0);
  std::vector<Unknown> unknowns;
  for (std::int32_t c = 0; c < grid.cells(); ++c) {
    if (cell::is_joined(guess[c]) && c != goal) unknowns.push_back({c, {0.0, 0.0, 0.0, 0.0}});
    if (cell::is_joined(guess[c])) v[static_cast<std::size_t>(c)] = 1.0;
  }
  std::sort(unknowns.begin(), unknowns.end(), [guess](const Unknown& a, const Unknown& b) {
    return guess[a.cell] < guess[b.cell] || (guess[a.cell] == guess[b.cell] && a.cell < b.cell);
  });
  const auto couple = [&] {
    for (Unknown& u : unknowns) {
      const std::int32_t i = u.cell % grid.side, j = u.cell / grid.side;
      const bool exists[4] = {i<grid.side - 1, i> 0, j<grid.side - 1, j> 0};
      for (int k = 0; k < 4; ++k) {
        const std::int32_t there = u.cell + step[k];
        if (!exists[k] || !cell::is_joined(guess[there])) continue;
        u.coupling[k] = 0.25 * std::exp(psi[static_cast<std::size_t>(u.cell)] - psi[static_cast<std::size_t>(there)]);
      }
    }
  };
  const auto relax = [&](const Unknown& u, double w) {
    const auto at = [&](int k) {
      return u.coupling[k] == 0.0 ? 0.0 : u.coupling[k] * v[static_cast<std::size_t>(u.cell + step[k])];
    };
    double& here = v[static_cast<std::size_t>(u.cell)];
    const double change = (at(0) + at(1)) + (at(2) + at(3)) - here;
    here += w * change;
    return std::fabs(change / here);
  };
  double moved = 1.0;
  for (int sweep = 0; sweep < most && moved > 1e-10; ++sweep) {
    if (sweep % 50 == 0) {
      for (std::size_t c = 0; c < n; ++c) {
        if (v[c] > 0.0) psi[c] -= std::log(v[c]), v[c] = 1.0;
      }
      couple();
    }
    const double w = sweep < 100 ? 1.0 : over;
    moved = 0.0;
    for (const Unknown& u : unknowns) moved = std::max(moved, relax(u, w));
    for (auto u = unknowns.rbegin(); u != unknowns.rend(); ++u) moved = std::max(moved, relax(*u, w));
  }
  for (std::size_t c = 0; c < n; ++c) {
    if (v[c] > 0.0) psi[c] -= std::log(v[c]);
  }
  return psi;
}

/// Share of joined cells, the goal apart, whose lowest 4-neighbour is the reference's lowest; one that the reference
/// puts within 1e-6 of its lowest counts, since a symmetric map has ties.
inline double share_of_best(const field::Grid& grid, const float* psi, const std::vector<double>& reference,
                            std::int32_t goal) {
  std::int64_t joined = 0, best = 0;
  for (std::int32_t c = 0; c < grid.cells(); ++c) {
    if (!cell::is_joined(psi[c]) || c == goal) continue;
    const std::int32_t i = c % grid.side, j = c / grid.side;
    std::int32_t chosen = c;
    double lowest = 1e300;
    const auto look = [&](bool exists, std::int32_t n) {
      if (!exists || !cell::is_joined(psi[n])) return;
      if (psi[n] < psi[chosen]) chosen = n;
      lowest = std::min(lowest, reference[static_cast<std::size_t>(n)]);
    };
    look(i < grid.side - 1, c + 1), look(i > 0, c - 1), look(j < grid.side - 1, c + grid.side),
        look(j > 0, c - grid.side);
    ++joined;
    if (chosen != c && reference[static_cast<std::size_t>(chosen)] <= lowest + 1e-6) ++best;
  }
  return joined == 0 ? 1.0 : static_cast<double>(best) / static_cast<double>(joined);
}

}  // namespace jaywalk::test
