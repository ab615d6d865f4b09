#pragma once
// The paper's third kernel: the harmonic potential, solved for v in u = exp(-psi) v, and the index matrix. Every level
// of the solver has the same form, x_c = sum of a_n x_n + source_c, so one relaxation serves them all.
//
// In complement and logarithm: u = 1 - phi, psi = -ln u. phi = 0 at the goal and 1 in obstacles becomes psi = 0 and
// infinity, and a falling phi a falling psi. A solution is kept as u = exp(-psi) v with v near 1, so that single
// precision resolves what phi cannot: in a corridor w cells wide u falls by exp(-k) a cell
// (docs/explanation/algorithm.md).
#include "planner/cell/cell.h"
#include "planner/paper/executor.h"

namespace jaywalk::paper {
/// Share that a cell takes of each neighbour.
struct Couplings {
  float east, west, north, south;
};

JAYWALK_CELL float sum(const Couplings& a) { return (a.east + a.west) + (a.north + a.south); }

/// Equation discrete-laplace, rebased: u_c = (sum of u_n)/4 with u = exp(-psi) v gives v_c = sum of
/// a_n v_n with a_n = exp(psi_c - psi_n)/4. What is not free has u = 0, takes nothing and gives nothing.
/// (Selects instead of branches here and below: they let four cells go at once.)
JAYWALK_CELL float coupling(float psi_here, float psi_neighbour, bool neighbour_exists) {
  float fall = cell::is_joined(psi_here) ? psi_here - psi_neighbour : 0.0F;
  fall = cell::is_joined(psi_neighbour) ? fall : 0.0F;
  float a = cell::is_joined(psi_here) ? 0.25F * cell::exp(fall) : 0.0F;
  a = cell::is_joined(psi_neighbour) ? a : 0.0F;
  return neighbour_exists ? a : 0.0F;
}

/// Share that the neighbour takes of this cell: exp(d)/4 one way is exp(-d)/4 the other.
JAYWALK_CELL float coupling_back(float coupling_there) {
  const float a = 0.0625F / (coupling_there > 0.0F ? coupling_there : 1.0F);
  return coupling_there > 0.0F ? a : 0.0F;
}

/// Weight of a cell's equation in its block's: exp(-2 (psi - base)) times what it was divided by; 0 without equation.
JAYWALK_CELL float block_weight(bool has_equation, float diagonal, float psi, float base) {
  const float rise = has_equation ? psi - base : 0.0F;
  const float weight = diagonal * cell::exp(-2.0F * rise);
  return has_equation ? weight : 0.0F;
}

/// The weighted mean that every level of the solver relaxes to: x_c = sum of a_n x_n + source.
JAYWALK_CELL float relaxed(const Couplings& a, float east, float west, float north, float south, float source) {
  return ((a.east * east + a.west * west) + (a.north * north + a.south * south)) + source;
}

/// v after a coarse correction: never below an eighth of what it was, since u stays positive. (Half would hold back a
/// level that is too high by a factor of two a cycle; less than a tenth leaves pits where a correction was too strong.)
JAYWALK_CELL float corrected(float v, float correction) {
  const float floor = 0.125F * v;
  const float moved = v + (v > 0.0F ? correction : 0.0F);
  return moved > floor ? moved : floor;
}

/// psi with v absorbed: -ln(exp(-psi) v); v = 0 is where there is no equation, and psi stays as it is. (A NaN less 0
/// would be another NaN on a GPU.)
JAYWALK_CELL float rebased(float psi, float v) {
  const float factor = v > 0.0F ? v : 1.0F;
  const float absorbed = psi - cell::log(factor);
  return v > 0.0F ? absorbed : psi;
}

template <class T>
struct Fill {
  T* x;
  T value;
  JAYWALK_CELL void operator()(std::int32_t c) const { x[c] = value; }
};

/// Couplings of a level's cells.
struct CouplingArrays {
  float *east, *west, *north, *south;

  [[nodiscard]] JAYWALK_CELL Couplings at(std::int32_t c) const { return {east[c], west[c], north[c], south[c]}; }
  JAYWALK_CELL void set(std::int32_t c, const Couplings& a) const {
    east[c] = a.east, west[c] = a.west, north[c] = a.north, south[c] = a.south;
  }
};

/// One level's equations: cells, or blocks of them.
struct Level {
  Grid grid;
  CouplingArrays couplings;
  float *psi, *source, *x;  ///< x may be read beyond the border (take_rows)
  // Of blocks alone:
  float* diagonal;                  ///< what the equation was divided by; cells' are not divided
  float *low_weight, *high_weight;  ///< of the block's (0, 0) and (1, 1) cells in its right-hand side
  /// Cells that a block speaks for: bits 0 to 3 for (0, 0), (1, 0), (0, 1), (1, 1); kOpenEast, kOpenNorth. May be
  /// read beyond the border (take_rows).
  std::int32_t* ties;

  /// Value to which a cell would relax. Beyond the border the coupling is 0 and the value finite.
  [[nodiscard]] JAYWALK_CELL float relaxed(std::int32_t c) const {
    return paper::relaxed(couplings.at(c), x[c + 1], x[c - 1], x[c + grid.side], x[c - grid.side], source[c]);
  }
};

/// psi of a cell's four neighbours, infinity or NaN outside the grid.
struct BesideCell {
  float east, west, north, south;
};

JAYWALK_CELL float barred_if(bool outside) { return outside ? cell::kUnreachable : 0.0F; }

/// Adds infinity where there is no neighbour, so that many cells go at once: psi may be read beyond (take_rows).
JAYWALK_CELL BesideCell beside_cell(const Grid& grid, const float* psi, std::int32_t i, std::int32_t j) {
  const std::int32_t c = grid.at(i, j), last = grid.side - 1;
  return {psi[c + 1] + barred_if(i == last), psi[c - 1] + barred_if(i == 0), psi[c + grid.side] + barred_if(j == last),
          psi[c - grid.side] + barred_if(j == 0)};
}

/// Couplings to the next cell east and north, from psi. What is not joined to the goal is uncoupled and 0.
struct CoupleAhead {
  Level cells;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t c = cells.grid.at(i, j), last = cells.grid.side - 1;
    const float here = cells.psi[c];
    cells.couplings.east[c] = coupling(here, cells.psi[c + 1], i < last);
    cells.couplings.north[c] = coupling(here, cells.psi[c + cells.grid.side], j < last);
    cells.source[c] = 0.0F;
    cells.x[c] = cell::is_joined(here) ? 1.0F : 0.0F;
  }
};

/// The couplings west and south, from what those neighbours have east and north.
struct CoupleBack {
  Level cells;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t c = cells.grid.at(i, j);
    cells.couplings.west[c] = i > 0 ? coupling_back(cells.couplings.east[c - 1]) : 0.0F;
    cells.couplings.south[c] = j > 0 ? coupling_back(cells.couplings.north[c - cells.grid.side]) : 0.0F;
  }
};

/// Takes the goal out of the unknowns: what its neighbours take of it (v = 1) becomes their source. One visit.
struct SettleGoal {
  Level cells;
  std::int32_t goal;

  JAYWALK_CELL void operator()(std::int32_t) const {
    const std::int32_t side = cells.grid.side, i = goal % side, j = goal / side;
    if (j > 0) move(cells.couplings.north, goal - side);
    if (j < side - 1) move(cells.couplings.south, goal + side);
    if (i > 0) move(cells.couplings.east, goal - 1);
    if (i < side - 1) move(cells.couplings.west, goal + 1);
    cells.couplings.set(goal, {0.0F, 0.0F, 0.0F, 0.0F});
    cells.source[goal] = 1.0F;
  }

 private:
  JAYWALK_CELL void move(float* towards_goal, std::int32_t c) const {
    cells.source[c] = towards_goal[c];
    towards_goal[c] = 0.0F;
  }
};

/// One colour of a red-black Gauss-Seidel sweep (equation harmonic-potential without its order: the paper's in-place
/// sweep gives other values in every other order). Visits the h-th cell of that colour in row j.
struct RelaxColour {
  Level level;
  std::int32_t colour;  ///< of cells with even or odd i + j

  JAYWALK_CELL void operator()(std::int32_t h, std::int32_t j) const {
    const std::int32_t c = level.grid.at(2 * h + ((j + colour) & 1), j);
    level.x[c] = level.relaxed(c);
  }
};

/// Carries v over into the equations: a_n v_n / v_c, so that v = 1 is where the next cycle starts.
struct RebaseCouplings {
  Level cells;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t c = cells.grid.at(i, j), side = cells.grid.side;
    const float* x = cells.x + c;
    const float scale = *x > 0.0F ? 1.0F / *x : 0.0F;
    const Couplings a = cells.couplings.at(c);
    cells.couplings.set(c, {a.east * (x[1] * scale), a.west * (x[-1] * scale), a.north * (x[side] * scale),
                            a.south * (x[-side] * scale)});
    cells.source[c] *= scale;
  }
};

/// Number of cells of a row whose correction v differs from the eastern or northern neighbour's by more than the share
/// `tilt`. Where v changed by the same factor all around, the levels moved and the gradient's direction did not.
struct TiltedOfRow {
  Grid grid;
  float tilt;
  const float* x;
  Counted* tilted;  ///< joined: cells with an equation

  JAYWALK_CELL void operator()(std::int32_t j) const {
    std::int32_t tilts = 0, joins = 0;
    for (std::int32_t i = 0; i < grid.side; ++i) {
      const float* at = x + grid.at(i, j);
      const float here = *at, most = tilt * here;
      const float east = i < grid.side - 1 ? at[1] : 0.0F, north = j < grid.side - 1 ? at[grid.side] : 0.0F;
      const bool from_east = differs(here, east, most), from_north = differs(here, north, most);
      joins += here > 0.0F ? 1 : 0;
      tilts += ((here > 0.0F) & (from_east | from_north)) ? 1 : 0;
    }
    tilted[j] = {tilts, joins};
  }

 private:
  /// True where it differs from a neighbour with an equation (v > 0).
  JAYWALK_CELL static bool differs(float here, float there, float most) {
    return (there > 0.0F) & ((there - here > most) | (here - there > most));
  }
};

/// Carries v over into psi and starts again from v = 1.
struct RebasePsi {
  float *x, *psi;

  JAYWALK_CELL void operator()(std::int32_t c) const {
    const float v = x[c];
    psi[c] = rebased(psi[c], v);
    x[c] = v > 0.0F ? 1.0F : v;
  }
};

/// Potential above the start field: where the next submission's solver begins. A covered cell keeps what it had.
struct KeepCorrection {
  const float *start, *psi;
  float* correction;

  JAYWALK_CELL void operator()(std::int32_t c) const {
    const float kept = correction[c], found = psi[c] - start[c];
    correction[c] = cell::is_joined(psi[c]) ? found : kept;
  }
};

struct AddCorrection {
  const float *start, *correction;
  float* psi;

  JAYWALK_CELL void operator()(std::int32_t c) const {
    psi[c] = cell::is_joined(start[c]) ? start[c] + correction[c] : start[c];
  }
};

/// Lifts each joined cell of one colour that has no strictly lower neighbour just above the lowest, as far as single
/// precision tells them apart: what rounding has levelled descends again. Even, then odd cells, some times over.
struct LiftPits {
  Grid grid;
  std::int32_t colour, goal;
  float* psi;  ///< may be read beyond the border (take_rows)

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t c = grid.at(i, j);
    const float here = psi[c];
    if (((i + j) & 1) != colour || !cell::is_joined(here) || c == goal) return;
    const BesideCell beside = beside_cell(grid, psi, i, j);
    float lowest = cell::kUnreachable;
    lowest = beside.east < lowest ? beside.east : lowest;
    lowest = beside.west < lowest ? beside.west : lowest;
    lowest = beside.north < lowest ? beside.north : lowest;
    lowest = beside.south < lowest ? beside.south : lowest;
    if (cell::is_joined(lowest) && !(lowest < here)) psi[c] = cell::next_above(lowest);
  }
};

/// The certificate, a row at a time: joined cells, the goal apart, that have no strictly lower one among their four
/// neighbours. None anywhere: descent arrives from everywhere, and only then.
struct PitsOfRow {
  Grid grid;
  std::int32_t goal;
  const float* psi;  ///< may be read beyond the border (take_rows)
  Counted* pits;     ///< joined: the row's joined cells, the goal included

  JAYWALK_CELL void operator()(std::int32_t j) const {
    std::int32_t pit_count = 0, joined_count = 0;
    for (std::int32_t i = 0; i < grid.side; ++i) {
      const std::int32_t c = grid.at(i, j);
      const float here = psi[c];
      const BesideCell beside = beside_cell(grid, psi, i, j);
      const bool has_lower =
          (beside.east < here) | (beside.west < here) | (beside.north < here) | (beside.south < here);
      const bool joins = cell::is_joined(here);
      joined_count += joins ? 1 : 0;
      pit_count += (joins & !has_lower & (c != goal)) ? 1 : 0;
    }
    pits[j] = {pit_count, joined_count};
  }
};

/// A step to one of the eight neighbours.
struct Step {
  std::int32_t di, dj;
};

/// Step of an entry of the index matrix: 0-3 straight, 4-7 diagonal, kHere and above nowhere.
inline constexpr std::uint8_t kHere = 8;
JAYWALK_CELL Step step_of(std::uint8_t index) {
  const std::int32_t k = index & 3;
  const Step straight{k == 0 ? 1 : (k == 1 ? -1 : 0), k == 2 ? 1 : (k == 3 ? -1 : 0)};
  const Step diagonal{(k & 1) == 0 ? 1 : -1, (k & 2) == 0 ? 1 : -1};
  return index < 4 ? straight : (index < kHere ? diagonal : Step{0, 0});
}

/// Equation index-matrix with eight neighbours for its four, which halve the raw path's stairs: the neighbour with the
/// lowest potential, a diagonal one only between two free cells, so that no corner is cut.
struct IndexOfEachCell {
  Grid grid;
  const float* psi;  ///< may be read beyond the border (take_rows)
  std::uint8_t* index;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t c = grid.at(i, j), up = c + grid.side, down = c - grid.side;
    const BesideCell beside = beside_cell(grid, psi, i, j);
    const bool east = cell::is_joined(beside.east), west = cell::is_joined(beside.west);
    const bool north = cell::is_joined(beside.north), south = cell::is_joined(beside.south);
    Lowest lowest{psi[c], kHere};
    lowest.look(beside.east, east, 0), lowest.look(beside.west, west, 1);
    lowest.look(beside.north, north, 2), lowest.look(beside.south, south, 3);
    lowest.look(psi[up + 1], north & east, 4), lowest.look(psi[up - 1], north & west, 5);
    lowest.look(psi[down + 1], south & east, 6), lowest.look(psi[down - 1], south & west, 7);
    index[c] = static_cast<std::uint8_t>(lowest.step);
  }

 private:
  struct Lowest {
    float psi;
    std::int32_t step;
    /// Nothing is lower than what is not free: NaN compares false.
    JAYWALK_CELL void look(float there, bool open, std::int32_t k) {
      const bool lower = open & (there < psi);
      psi = lower ? there : psi;
      step = lower ? k : step;
    }
  };
};

}  // namespace jaywalk::paper
