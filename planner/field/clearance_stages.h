#pragma once
// How far every cell is from what is not free: exact Euclidean distance, a column then a row at a time; or, for many
// threads, a cell at a time.
#include "planner/cell/clearance.h"
#include "planner/mapping/grid.h"

namespace jaywalk::field {

/// Cells to the first one outside; 0 or less where the cell is outside itself.
JAYWALK_CELL std::int32_t cells_to_border(std::int32_t i, std::int32_t j, std::int32_t width, std::int32_t height) {
  const std::int32_t x = i < width - 1 - i ? i : width - 1 - i;
  const std::int32_t y = j < height - 1 - j ? j : height - 1 - j;
  return (x < y ? x : y) + 1;
}

/// Rows from each cell of a strip of columns to the nearest occupied cell of its column. How many columns a visit
/// takes is the executor's choice: one for a thread of many, enough to fill the vectors and lines of a processor.
struct NearestInColumns {
  Grid grid;
  std::int32_t columns;  ///< of a strip; divides the grid's side
  const std::uint8_t* occupants;
  std::uint8_t wanted;  ///< the occupants that count
  std::int32_t* rows_away;

  JAYWALK_CELL void operator()(std::int32_t strip) const {
    const std::int32_t none = 2 * grid.side, last = grid.side - 1;
    for (std::int32_t j = 0; j <= last; ++j) {
      for (std::int32_t c = grid.at(strip * columns, j), end = c + columns; c < end; ++c) {
        const std::int32_t below = j > 0 ? rows_away[c - grid.side] : none;
        const std::int32_t away = below < none ? below + 1 : none;
        rows_away[c] = (occupants[c] & wanted) != 0 ? 0 : away;
      }
    }
    for (std::int32_t j = last - 1; j >= 0; --j) {
      for (std::int32_t c = grid.at(strip * columns, j), end = c + columns; c < end; ++c) {
        const std::int32_t here = rows_away[c], away = rows_away[c + grid.side] + 1;
        rows_away[c] = away < here ? away : here;
      }
    }
  }
};

/// Cells of a column that a word holds, a bit each.
inline constexpr std::int32_t kRowsOfWord = 32;

/// For many threads, three steps without a serial one among them: which cells are occupied, a word of a column a visit.
struct OccupiedInColumn {
  Grid grid;
  const std::uint8_t* occupants;
  std::uint8_t wanted;
  std::uint32_t* columns;  ///< words, row of words by row

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t word) const {
    std::uint32_t bits = 0;
    for (std::int32_t k = 0; k < kRowsOfWord; ++k) {
      const std::uint8_t occupant = occupants[grid.at(i, word * kRowsOfWord + k)];
      bits |= (occupant & wanted) != 0 ? 1U << k : 0U;
    }
    columns[grid.at(i, word)] = bits;
  }
};

/// Then rows from each cell to the nearest of its column, as NearestInColumns has them.
struct NearestInColumn {
  Grid grid;
  const std::uint32_t* columns;
  std::int32_t* rows_away;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t none = 2 * grid.side, word = j / kRowsOfWord, bit = j % kRowsOfWord;
    std::int32_t above = none, below = none;
    for (std::int32_t w = word; w < grid.side / kRowsOfWord && above == none; ++w) {
      const std::uint32_t bits = columns[grid.at(i, w)] & (w == word ? ~0U << bit : ~0U);
      if (bits != 0) above = w * kRowsOfWord + cell::lowest_bit(bits) - j;
    }
    for (std::int32_t w = word; w >= 0 && below == none; --w) {
      const std::uint32_t bits = columns[grid.at(i, w)] & (w == word ? ~0U >> (kRowsOfWord - 1 - bit) : ~0U);
      if (bits != 0) below = j - w * kRowsOfWord - cell::highest_bit(bits);
    }
    rows_away[grid.at(i, j)] = above < below ? above : below;
  }
};

/// And each cell's clearance: it looks along its row for as long as something nearer may lie there.
struct ClearanceOfCell {
  Grid grid;
  std::int32_t width, height;  ///< as ClearanceOfRow has them
  const std::int32_t* rows_away;
  float inflation;  ///< cells
  float* clearance;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t* g = rows_away + grid.at(0, j);
    std::int32_t nearest = cell::squared_distance(i, i, g[i]);
    for (std::int32_t d = 1; d < grid.side && d * d < nearest; ++d) {
      nearest = i >= d ? lower(nearest, cell::squared_distance(i, i - d, g[i - d])) : nearest;
      nearest = i + d < grid.side ? lower(nearest, cell::squared_distance(i, i + d, g[i + d])) : nearest;
    }
    clearance[grid.at(i, j)] = cell::clearance(nearest, inflation, cells_to_border(i, j, width, height));
  }

 private:
  JAYWALK_CELL static std::int32_t lower(std::int32_t a, std::int32_t b) { return a < b ? a : b; }
};

/// The lower envelope of a row's columns, then each cell's clearance; 0 where it is not free.
struct ClearanceOfRow {
  Grid grid;
  std::int32_t width, height;  ///< cells of the grid that count; what lies beyond is outside
  const std::int32_t* rows_away;
  float inflation;         ///< cells
  std::int32_t* envelope;  ///< columns whose obstacle is the nearest of some stretch; in the end squared distances
  std::int32_t* stretch;   ///< room for a row: where each of those stretches begins
  float* clearance;

  JAYWALK_CELL void operator()(std::int32_t j) const {
    const std::int32_t row = grid.at(0, j);
    const std::int32_t* g = rows_away + row;
    std::int32_t* column = envelope + row;
    std::int32_t* begin = stretch + row;
    std::int32_t top = 0;
    column[0] = begin[0] = 0;
    for (std::int32_t u = 1; u < grid.side; ++u) {
      while (top >= 0 && cell::squared_distance(begin[top], column[top], g[column[top]]) >
                             cell::squared_distance(begin[top], u, g[u])) {
        --top;
      }
      const std::int32_t from = top < 0 ? 0 : 1 + cell::last_nearer(column[top], g[column[top]], u, g[u]);
      if (from >= grid.side) continue;
      ++top;
      column[top] = u;
      begin[top] = from;
    }
    for (std::int32_t i = grid.side - 1; i >= 0; --i) {
      const std::int32_t squared = cell::squared_distance(i, column[top], g[column[top]]);
      if (i == begin[top]) --top;
      column[i] = squared;  // beyond what is left of the envelope
      write(i, j, squared);
    }
  }

  JAYWALK_CELL void write(std::int32_t i, std::int32_t j, std::int32_t squared) const {
    clearance[grid.at(i, j)] = cell::clearance(squared, inflation, cells_to_border(i, j, width, height));
  }
};

}  // namespace jaywalk::field
