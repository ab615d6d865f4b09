#pragma once
// The paper's third kernel: the harmonic potential, solved for v in u = exp(-psi) v. Every level of the
// solver has the same form, x_c = sum of a_n x_n + source_c, so one relaxation serves them all.
#include "planner/cell/potential.h"
#include "planner/field/board.h"
#include "planner/field/executor.h"

namespace jaywalk::field {

template <class T>
struct Fill {
  T* x;
  T value;
  JAYWALK_CELL void operator()(std::int32_t c) const { x[c] = value; }
};

template <class T>
struct Copy {
  const T* from;
  T* to;
  JAYWALK_CELL void operator()(std::int32_t c) const { to[c] = from[c]; }
};

/// psi of a cell's four neighbours, infinity or NaN outside the grid.
struct BesideCell {
  float east, west, north, south;
};

JAYWALK_CELL float barred_if(bool outside) { return outside ? cell::kUnreachable : 0.0F; }

/// Adds infinity where there is no neighbour instead of asking first, so that many cells go at once: psi may be read a
/// row and a cell beyond either end.
JAYWALK_CELL BesideCell beside_cell(const Grid& grid, const float* psi, std::int32_t i, std::int32_t j) {
  const std::int32_t c = grid.at(i, j), last = grid.side - 1;
  return {psi[c + 1] + barred_if(i == last), psi[c - 1] + barred_if(i == 0), psi[c + grid.side] + barred_if(j == last),
          psi[c - grid.side] + barred_if(j == 0)};
}

/// An array from rows to a board.
struct ToBoard {
  Board board;
  const float* by_rows;
  float* on_board;
  JAYWALK_CELL void operator()(std::int32_t h, std::int32_t j) const { board.place(h, j, by_rows, on_board); }
};

/// And back.
struct FromBoard {
  Board board;
  const float* on_board;
  float* by_rows;
  JAYWALK_CELL void operator()(std::int32_t h, std::int32_t j) const { board.take_back(h, j, on_board, by_rows); }
};

/// Sets up the finest level from psi, one colour: couplings to the next cell east and north. What is not
/// free or not joined to the goal is uncoupled and 0.
struct CoupleAhead {
  Board board;
  std::int32_t colour;
  const float* psi;
  CouplingArrays couplings;
  Sources sources;
  float* x;

  JAYWALK_CELL void operator()(std::int32_t h, std::int32_t j) const {
    const std::int32_t c = board.row(colour, j) + h;
    const Neighbours n = board.neighbours(colour, h, j);
    const std::int32_t i = 2 * h + Board::first_column(colour, j);
    couplings.east[c] = cell::coupling(psi[c], psi[n.east], i < board.side - 1);
    couplings.north[c] = cell::coupling(psi[c], psi[n.north], j < board.side - 1);
    sources.values[sources.row(board, colour, j) + h] = 0.0F;
    x[c] = cell::is_joined(psi[c]) ? 1.0F : 0.0F;
  }
};

/// The couplings west and south, from what those neighbours have east and north.
struct CoupleBack {
  Board board;
  std::int32_t colour;
  const float* psi;
  CouplingArrays couplings;

  JAYWALK_CELL void operator()(std::int32_t h, std::int32_t j) const {
    const std::int32_t c = board.row(colour, j) + h;
    const Neighbours n = board.neighbours(colour, h, j);
    const bool has_west = h > 0 || Board::first_column(colour, j) > 0;
    couplings.west[c] = has_west ? cell::coupling_back(couplings.east[n.west]) : 0.0F;
    couplings.south[c] = j > 0 ? cell::coupling_back(couplings.north[n.south]) : 0.0F;
  }
};

/// Takes the goal out of the unknowns: what its neighbours take of it (v = 1) becomes their source, and it
/// is uncoupled with source 1. One visit.
struct SettleGoal {
  Board board;
  std::int32_t goal;  ///< numbered by rows
  CouplingArrays couplings;
  float* source;

  JAYWALK_CELL void operator()(std::int32_t) const {
    const std::int32_t i = goal % board.side, j = goal / board.side;
    if (j > 0) move(couplings.north, board.at(i, j - 1));
    if (j < board.side - 1) move(couplings.south, board.at(i, j + 1));
    if (i > 0) move(couplings.east, board.at(i - 1, j));
    if (i < board.side - 1) move(couplings.west, board.at(i + 1, j));
    couplings.set(board.at(i, j), {0.0F, 0.0F, 0.0F, 0.0F});
    source[board.at(i, j)] = 1.0F;
  }

 private:
  JAYWALK_CELL void move(float* towards_goal, std::int32_t c) const {
    source[c] = towards_goal[c];
    towards_goal[c] = 0.0F;
  }
};

/// One colour of a red-black Gauss-Seidel sweep (equation harmonic-potential without its order: the
/// paper's in-place sweep gives other values in every other order).
struct RelaxColour {
  Board board;
  std::int32_t colour;
  CouplingArrays couplings;
  Sources sources;
  float* x;

  JAYWALK_CELL void operator()(std::int32_t h, std::int32_t j) const {
    const std::int32_t c = board.row(colour, j) + h;
    const float source = sources.values[sources.row(board, colour, j) + h];
    x[c] = relaxed_at(couplings, source, x, c, board.neighbours(colour, h, j));
  }
};

/// Carries v over into the equations: a_n v_n / v_c, so that v = 1 is where the next cycle starts. One colour.
struct RebaseCouplings {
  Board board;
  std::int32_t colour;
  const float* x;
  CouplingArrays couplings;
  Sources sources;

  JAYWALK_CELL void operator()(std::int32_t h, std::int32_t j) const {
    const std::int32_t c = board.row(colour, j) + h;
    const Neighbours n = board.neighbours(colour, h, j);
    const float scale = x[c] > 0.0F ? 1.0F / x[c] : 0.0F;
    const cell::Couplings a = couplings.at(c);
    couplings.set(c, {a.east * (x[n.east] * scale), a.west * (x[n.west] * scale), a.north * (x[n.north] * scale),
                      a.south * (x[n.south] * scale)});
    sources.values[sources.row(board, colour, j) + h] *= scale;
  }
};

/// How many cells of a piece of a row a cycle has tilted: those whose v differs from their eastern or northern
/// neighbour's by more than `tilt` of it. A v that has changed alike all around has moved levels, not directions.
struct TiltedOfRow {
  Board board;
  std::int32_t cells;  ///< of a piece, an even number; divides the side
  float tilt;
  const float* x;
  Counted* tilted;  ///< of each piece, row by row; joined: cells with an equation

  JAYWALK_CELL void operator()(std::int32_t piece, std::int32_t j) const {
    std::int32_t tilts = 0, joins = 0;
    for (std::int32_t colour = 0; colour < 2; ++colour) {
      const std::int32_t first = board.row(colour, j), last_east = (j + colour + 1) & 1;
      for (std::int32_t h = piece * (cells / 2), end = h + cells / 2; h < end; ++h) {
        const Neighbours n = board.neighbours(colour, h, j);
        const float here = x[first + h], most = tilt * here;
        const float east = h < board.half() - 1 + last_east ? x[n.east] : 0.0F, north = x[n.north];
        joins += here > 0.0F ? 1 : 0;
        const bool from_east = differs(here, east, most), from_north = differs(here, north, most);
        tilts += ((here > 0.0F) & (from_east | from_north)) ? 1 : 0;
      }
    }
    tilted[j * (board.side / cells) + piece] = {tilts, joins};
  }

 private:
  /// From a neighbour that has an equation, that is v > 0.
  JAYWALK_CELL static bool differs(float here, float there, float most) {
    return (there > 0.0F) & ((there - here > most) | (here - there > most));
  }
};

/// Carries v over into psi and starts again from v = 1. One colour.
struct RebasePsi {
  Board board;
  std::int32_t colour;
  float* x;
  float* psi;

  JAYWALK_CELL void operator()(std::int32_t h, std::int32_t j) const {
    const std::int32_t c = board.row(colour, j) + h;
    const float v = x[c];
    psi[c] = cell::rebased(psi[c], v);
    x[c] = v > 0.0F ? 1.0F : v;
  }
};

/// What the potential came to above the start field, by cell: where the next submission's solver begins. A
/// cell that is covered for a while keeps what it had, so that a mover passing leaves no scar.
struct KeepCorrection {
  Grid grid;
  const float* start;
  const float* psi;
  float* correction;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t c = grid.at(i, j);
    const float kept = correction[c], found = psi[c] - start[c];
    correction[c] = cell::is_joined(psi[c]) ? found : kept;
  }
};

struct AddCorrection {
  Grid grid;
  const float* start;
  const float* correction;
  float* psi;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t c = grid.at(i, j);
    psi[c] = cell::is_joined(start[c]) ? start[c] + correction[c] : start[c];
  }
};

/// Lifts each joined cell of one colour that has no strictly lower neighbour just above the lowest, as far as single
/// precision tells them apart: what rounding has levelled descends again. Even, then odd cells, some times over. Visits
/// rows; those that no lift has come to yet it leaves alone.
struct LiftPitsOfRow {
  Grid grid;
  std::int32_t colour;
  std::int32_t goal;
  std::int32_t lifts;   ///< since the pits were counted, this one included
  std::int32_t cells;   ///< of a row that pits were counted in at a time
  const Counted* pits;  ///< as the certificate counted them
  float* psi;           ///< may be read beyond the border (take_rows)

  JAYWALK_CELL void operator()(std::int32_t, std::int32_t j) const {
    const std::int32_t low = j - lifts > 0 ? j - lifts : 0, high = j + lifts < grid.side ? j + lifts + 1 : grid.side;
    const std::int32_t pieces = grid.side / cells;
    std::int32_t near = 0;
    for (std::int32_t k = low * pieces; k < high * pieces; ++k) near += pits[k].cells;
    for (std::int32_t h = 0; near > 0 && h < grid.side / 2; ++h) lift(2 * h + Board::first_column(colour, j), j);
  }

 private:
  JAYWALK_CELL void lift(std::int32_t i, std::int32_t j) const {
    const std::int32_t c = grid.at(i, j);
    const float here = psi[c];
    if (!cell::is_joined(here) || c == goal) return;
    const BesideCell beside = beside_cell(grid, psi, i, j);
    float lowest = cell::kUnreachable;
    lowest = beside.east < lowest ? beside.east : lowest;
    lowest = beside.west < lowest ? beside.west : lowest;
    lowest = beside.north < lowest ? beside.north : lowest;
    lowest = beside.south < lowest ? beside.south : lowest;
    if (cell::is_joined(lowest) && !(lowest < here)) psi[c] = cell::next_above(lowest);
  }
};

/// The certificate, a piece of a row at a time: joined cells, the goal apart, that have no strictly lower one among
/// their four neighbours. None anywhere: descent arrives from everywhere, and only then.
struct PitsOfRow {
  Grid grid;
  std::int32_t goal;
  std::int32_t cells;  ///< of a piece; divides the side
  const float* psi;    ///< may be read beyond the border (take_rows)
  Counted* pits;       ///< of each piece, row by row; joined: its joined cells, the goal included

  JAYWALK_CELL void operator()(std::int32_t piece, std::int32_t j) const {
    std::int32_t pit_count = 0, joined_count = 0;
    for (std::int32_t i = piece * cells, end = i + cells; i < end; ++i) {
      const std::int32_t c = grid.at(i, j);
      const float here = psi[c];
      const BesideCell beside = beside_cell(grid, psi, i, j);
      const bool has_lower =
          (beside.east < here) | (beside.west < here) | (beside.north < here) | (beside.south < here);
      const bool joins = cell::is_joined(here);
      joined_count += joins ? 1 : 0;
      pit_count += (joins & !has_lower & (c != goal)) ? 1 : 0;
    }
    pits[j * (grid.side / cells) + piece] = {pit_count, joined_count};
  }
};

}  // namespace jaywalk::field
