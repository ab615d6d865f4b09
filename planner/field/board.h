#pragma once
#include "planner/cell/potential.h"
#include "planner/mapping/grid.h"

namespace jaywalk::field {

/// Where a cell's four neighbours are kept.
struct Neighbours {
  std::int32_t east, west, north, south;
};

/// A square of cells kept by colour, as on a chessboard: first the cells with even i + j, then the odd
/// ones, each colour row by row with a spare row below and above. What a row of one colour needs of its
/// neighbours then lies side by side, and four or eight cells are relaxed at a time. A cell is
/// (colour, h, j): the h-th of its colour in row j, that is i = 2 h + ((j + colour) & 1).
struct Board {
  std::int32_t side = 0;  ///< even

  [[nodiscard]] JAYWALK_CELL std::int32_t half() const { return side / 2; }
  /// Values that an array needs, the spare rows included.
  [[nodiscard]] JAYWALK_CELL std::int32_t size() const { return side * (side + 2); }
  /// Rows of both colours, the spare ones included, half() values each.
  [[nodiscard]] JAYWALK_CELL std::int32_t rows() const { return 2 * (side + 2); }
  /// Place of a row's first cell of that colour; j from -1 to side.
  [[nodiscard]] JAYWALK_CELL std::int32_t row(std::int32_t colour, std::int32_t j) const {
    return (colour * (side + 2) + j + 1) * half();
  }
  [[nodiscard]] JAYWALK_CELL std::int32_t at(std::int32_t i, std::int32_t j) const {
    return row((i + j) & 1, j) + i / 2;
  }
  /// First column of that colour in row j: 0 or 1.
  [[nodiscard]] JAYWALK_CELL static std::int32_t first_column(std::int32_t colour, std::int32_t j) {
    return (j + colour) & 1;
  }
  /// Cells 2 h and 2 h + 1 of row j from an array by rows to one of this board, and back.
  template <class T>
  JAYWALK_CELL void place(std::int32_t h, std::int32_t j, const T* by_rows, T* on_board) const {
    on_board[row(j & 1, j) + h] = by_rows[j * side + 2 * h];
    on_board[row(1 - (j & 1), j) + h] = by_rows[j * side + 2 * h + 1];
  }
  template <class T>
  JAYWALK_CELL void take_back(std::int32_t h, std::int32_t j, const T* on_board, T* by_rows) const {
    by_rows[j * side + 2 * h] = on_board[row(j & 1, j) + h];
    by_rows[j * side + 2 * h + 1] = on_board[row(1 - (j & 1), j) + h];
  }
  /// All of the other colour. Beyond the border they are some other cell's place, never outside the array.
  [[nodiscard]] JAYWALK_CELL Neighbours neighbours(std::int32_t colour, std::int32_t h, std::int32_t j) const {
    const std::int32_t other = 1 - colour;
    const std::int32_t beside = row(other, j) + h + first_column(colour, j);
    return {beside, beside - 1, row(other, j + 1) + h, row(other, j - 1) + h};
  }
};

/// What each cell of a board takes of its neighbours.
struct CouplingArrays {
  float *east, *west, *north, *south;

  [[nodiscard]] JAYWALK_CELL cell::Couplings at(std::int32_t c) const { return {east[c], west[c], north[c], south[c]}; }
  JAYWALK_CELL void set(std::int32_t c, const cell::Couplings& a) const {
    east[c] = a.east, west[c] = a.west, north[c] = a.north, south[c] = a.south;
  }
};

/// The sources of a level's equations. Rows outside [first, last] have none: they share a spare one of zeros, which
/// stays in the nearest cache where a row of their own each would come from memory. Whatever a stage makes of it is 0
/// again, so all may write there, one after the other.
struct Sources {
  float* values;
  std::int32_t first, last;

  /// Place of a row's first cell of that colour.
  [[nodiscard]] JAYWALK_CELL std::int32_t row(const Board& board, std::int32_t colour, std::int32_t j) const {
    const bool has_any = j >= first && j <= last;
    return board.row(colour, has_any ? j : -1);
  }
};

/// What a cell would relax to. Beyond the border the coupling is 0 and the value finite.
JAYWALK_CELL float relaxed_at(const CouplingArrays& couplings, float source, const float* x, std::int32_t c,
                              const Neighbours& n) {
  return cell::relaxed(couplings.at(c), x[n.east], x[n.west], x[n.north], x[n.south], source);
}

}  // namespace jaywalk::field
