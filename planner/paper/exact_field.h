#pragma once
// The harmonic potential to the last digit, by elimination in double precision: what the solver is measured against.
// Slow (the number of cells times the square of the wavefront's length); not for the loop.
#include <vector>

#include "planner/paper/executor.h"

namespace jaywalk::paper {
/// psi = -ln u of every cell that `goal` can be reached from through `free` cells (by rows, non-zero: free); infinity
/// elsewhere. u is 1 at the goal, the mean of its four neighbours in free cells, and 0 in all others and outside.
/// Cells are eliminated from the farthest to the nearest as an electrical network's nodes are (star to mesh): sums,
/// products and quotients of positive numbers only, so that every cell is right to about 1e-12 however small u is.
[[nodiscard]] std::vector<double> exact_psi(Grid grid, const std::uint8_t* free, std::int32_t goal);

/// What exact_psi would take, in multiplications; a billion is about a second.
[[nodiscard]] double exact_cost(Grid grid, const std::uint8_t* free, std::int32_t goal);

/// Share of cells with a finite `exact`, the goal apart, whose lowest 4-neighbour by `psi` is the lowest by `exact`.
/// One that `exact` puts within 1e-6 of its lowest counts too: a symmetric map has ties. 1 where there are none.
[[nodiscard]] double share_of_best(Grid grid, const float* psi, const std::vector<double>& exact, std::int32_t goal);

}  // namespace jaywalk::paper
