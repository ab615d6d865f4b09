#pragma once
// Solves the rebased potential by V-cycles over blocks of 2 x 2. Order only; no formula lives here.
#include <cstddef>
#include <vector>

#include "planner/field/coarse_stages.h"
#include "planner/field/potential_stages.h"

namespace jaywalk::field {

template <class Executor>
class Multigrid {
 public:
  /// Takes memory for grids up to `max_side` cells, a power of two times kCoarsestSide or more.
  Multigrid(Executor& executor, std::int32_t max_side) : executor_(executor) {
    for (std::int32_t side = max_side; side >= kCoarsestSide; side /= 2) arrays_.push_back(take_level(side));
    const auto cells = static_cast<std::size_t>(Grid{max_side}.cells());
    ones_ = executor_.template take<float>(cells);
    executor_.for_each(Grid{max_side}.cells(), Fill<float>{ones_, 1.0F});
    executor_.wait();
  }

  /// Improves psi, an estimate with cell::kUnreachable and cell::kNotFree where that is so, by `cycles` cycles. The
  /// blocks are weighted afresh each time: with the weights of the cycle before the second makes things worse.
  void improve(Grid grid, std::int32_t goal, float* psi, std::int32_t cycles) noexcept {
    Arrays& finest = arrays_[0];
    executor_.for_each_cell(grid.side, grid.side,
                            CoupleCells{grid, goal, psi, finest.couplings, finest.source, finest.x});
    for (std::int32_t k = 0; k < cycles; ++k) {
      coarsen(grid, psi);
      cycle(grid, 0);
      executor_.for_each(grid.cells(), RebaseCouplings{grid, goal, finest.x, finest.couplings, finest.source});
      executor_.for_each(grid.cells(), RebasePsi{finest.x, psi});
    }
  }

 private:
  static constexpr std::int32_t kCoarsestSide = 4;
  static constexpr std::int32_t kSweeps = 2;          ///< before and after each correction
  static constexpr std::int32_t kCoarsestSweeps = 8;  ///< settles 4 x 4 blocks

  struct Arrays {
    cell::Couplings* couplings;
    float *psi, *diagonal, *weight, *source, *x;
  };

  Arrays take_level(std::int32_t side) {
    const auto cells = static_cast<std::size_t>(Grid{side}.cells());
    const auto row = static_cast<std::size_t>(side);
    const auto take = [&] { return executor_.template take<float>(cells); };
    return {executor_.template take<cell::Couplings>(cells),      take(), take(), take(), take(),
            executor_.template take<float>(cells + 2 * row) + row};
  }

  [[nodiscard]] Level level(Grid grid, std::size_t depth, const float* psi) const noexcept {
    const Arrays& a = arrays_[depth];
    return {grid, depth == 0 ? psi : a.psi, depth == 0 ? ones_ : a.diagonal, a.couplings, a.weight};
  }

  [[nodiscard]] static bool is_coarsest(Grid grid) noexcept { return grid.side <= kCoarsestSide || grid.side % 4 != 0; }

  void coarsen(Grid grid, const float* psi) noexcept {
    for (std::size_t depth = 0; !is_coarsest(grid); ++depth) {
      const Grid blocks{grid.side / 2};
      Arrays& next = arrays_[depth + 1];
      executor_.for_each_cell(blocks.side, blocks.side,
                              CoarsenBlock{level(grid, depth, psi), blocks, next.psi, next.diagonal, next.couplings});
      grid = blocks;
    }
  }

  void relax(Grid grid, Arrays& a, std::int32_t sweeps) noexcept {
    for (std::int32_t k = 0; k < 2 * sweeps; ++k) {
      executor_.for_each_cell(grid.side / 2, grid.side, RelaxColour{grid, k & 1, a.couplings, a.source, a.x});
    }
  }

  void cycle(Grid grid, std::size_t depth) noexcept {
    Arrays& fine = arrays_[depth];
    if (is_coarsest(grid)) {
      relax(grid, fine, kCoarsestSweeps);
      return;
    }
    const Grid blocks{grid.side / 2};
    Arrays& coarse = arrays_[depth + 1];
    relax(grid, fine, kSweeps);
    executor_.for_each_cell(
        blocks.side, blocks.side,
        RestrictToBlock{level(grid, depth, nullptr), fine.source, fine.x, blocks, coarse.source, coarse.x});
    cycle(blocks, depth + 1);
    executor_.for_each_cell(grid.side, grid.side,
                            ProlongToCell{blocks, coarse.couplings, coarse.x, grid, depth == 0, fine.x});
    relax(grid, fine, kSweeps);
  }

  Executor& executor_;
  std::vector<Arrays> arrays_;
  float* ones_ = nullptr;  ///< the finest level's diagonal
};

}  // namespace jaywalk::field
