#pragma once
// The paper's third kernel: the harmonic potential, solved for v in u = exp(-psi) v. Every level of the
// solver has the same form, x_c = sum of a_n x_n + source_c, so one relaxation serves them all.
// Arrays marked "ringed" may be read one row before the first and after the last.
#include "planner/cell/potential.h"
#include "planner/field/grid.h"

namespace jaywalk::field {

template <class T>
struct Fill {
  T* x;
  T value;
  JAYWALK_CELL void operator()(std::int32_t c) const { x[c] = value; }
};

/// psi of a cell, or "not free" outside the grid.
JAYWALK_CELL float psi_at(const Grid& grid, const float* psi, std::int32_t i, std::int32_t j) {
  return grid.holds(i, j) ? psi[grid.at(i, j)] : cell::kNotFree;
}

/// Sets up the finest level from psi: couplings among unknowns, the goal's (v = 1) as source. The goal
/// itself is uncoupled with source 1; what is not free or not joined to the goal is uncoupled with 0.
struct CoupleCells {
  Grid grid;
  std::int32_t goal;
  const float* psi;
  cell::Couplings* couplings;
  float* source;
  float* x;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t c = grid.at(i, j);
    const bool joined = cell::is_joined(psi[c]);
    cell::Couplings a{0.0F, 0.0F, 0.0F, 0.0F};
    float from_goal = c == goal ? 1.0F : 0.0F;
    if (joined && c != goal) {
      a = {take(c, i + 1, j, from_goal), take(c, i - 1, j, from_goal), take(c, i, j + 1, from_goal),
           take(c, i, j - 1, from_goal)};
    }
    couplings[c] = a;
    source[c] = from_goal;
    x[c] = joined ? 1.0F : 0.0F;
  }

 private:
  JAYWALK_CELL float take(std::int32_t c, std::int32_t i, std::int32_t j, float& from_goal) const {
    const float a = cell::coupling(psi[c], psi_at(grid, psi, i, j));
    if (i != goal % grid.side || j != goal / grid.side) return a;
    from_goal += a;
    return 0.0F;
  }
};

/// What a cell would relax to; `x` is ringed.
JAYWALK_CELL float relaxed_at(const Grid& grid, std::int32_t c, const cell::Couplings* couplings, const float* source,
                              const float* x) {
  return cell::relaxed(couplings[c], x[c + 1], x[c - 1], x[c + grid.side], x[c - grid.side], source[c]);
}

/// One colour of a red-black Gauss-Seidel sweep (equation harmonic-potential without its order: the
/// paper's in-place sweep gives other values in every other order). Visits side/2 x side cells.
struct RelaxColour {
  Grid grid;
  std::int32_t colour;  ///< 0 or 1
  const cell::Couplings* couplings;
  const float* source;
  float* x;

  JAYWALK_CELL void operator()(std::int32_t half_i, std::int32_t j) const {
    const std::int32_t c = grid.at(2 * half_i + ((j + colour) & 1), j);
    x[c] = relaxed_at(grid, c, couplings, source, x);
  }
};

/// Carries v over into the equations: a_n v_n / v_c, so that v = 1 is where the next cycle starts. `x` is ringed.
struct RebaseCouplings {
  Grid grid;
  std::int32_t goal;
  const float* x;
  cell::Couplings* couplings;
  float* source;

  JAYWALK_CELL void operator()(std::int32_t c) const {
    if (c == goal || x[c] <= 0.0F) return;
    const float scale = 1.0F / x[c];
    cell::Couplings& a = couplings[c];
    a.east *= x[c + 1] * scale;
    a.west *= x[c - 1] * scale;
    a.north *= x[c + grid.side] * scale;
    a.south *= x[c - grid.side] * scale;
    source[c] *= scale;
  }
};

/// Carries v over into psi and starts again from v = 1.
struct RebasePsi {
  float* x;
  float* psi;

  JAYWALK_CELL void operator()(std::int32_t c) const {
    if (x[c] <= 0.0F) return;
    psi[c] = cell::rebased(psi[c], x[c]);
    x[c] = 1.0F;
  }
};

/// What the potential came to above the start field, by cell: where the next submission's solver begins. A
/// cell that is covered for a while keeps what it had, so that a mover passing leaves no scar.
struct KeepCorrection {
  const float* start;
  const float* psi;
  float* correction;

  JAYWALK_CELL void operator()(std::int32_t c) const {
    if (cell::is_joined(psi[c])) correction[c] = psi[c] - start[c];
  }
};

struct AddCorrection {
  const float* start;
  const float* correction;
  float* psi;

  JAYWALK_CELL void operator()(std::int32_t c) const {
    psi[c] = cell::is_joined(start[c]) ? start[c] + correction[c] : start[c];
  }
};

/// The certificate, a row at a time: joined cells, the goal apart, that have no strictly lower one among
/// their four neighbours. None anywhere: descent arrives from everywhere, and only then.
struct PitsOfRow {
  Grid grid;
  std::int32_t goal;
  const float* psi;
  std::int32_t* pits;
  std::int32_t* joined;  ///< joined cells of the row, the goal included

  JAYWALK_CELL void operator()(std::int32_t j) const {
    std::int32_t pit_count = 0, joined_count = 0;
    for (std::int32_t i = 0; i < grid.side; ++i) {
      const float here = psi[grid.at(i, j)];
      if (!cell::is_joined(here)) continue;
      ++joined_count;
      const bool has_lower = psi_at(grid, psi, i + 1, j) < here || psi_at(grid, psi, i - 1, j) < here ||
                             psi_at(grid, psi, i, j + 1) < here || psi_at(grid, psi, i, j - 1) < here;
      if (!has_lower && grid.at(i, j) != goal) ++pit_count;
    }
    pits[j] = pit_count;
    joined[j] = joined_count;
  }
};

}  // namespace jaywalk::field
