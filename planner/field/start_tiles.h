#pragma once
// The start field by a crew, tile by tile and without meetings: costs only fall, and what they fall to is the same in
// whatever order steps are taken (start_field.h), so blocks need not wait for one another. Each looks after some tiles
// of 64 x 64 cells. Of one that a neighbour has changed the border of it takes in what has changed, relaxes all of the
// tile's lines in eight directions at a time until nothing falls, and tells the neighbours that share a changed border.
#include "planner/field/crew.h"
#include "planner/field/field_arrays.h"
#include "planner/field/nearest_cell.h"

namespace jaywalk::field {

/// A tile in a block's memory.
struct StartTile {
  static constexpr std::int32_t kSide = kStartTile;
  static constexpr std::int32_t kStride = kSide + 1;  ///< so that a row's cells do not wait for a column's
  std::uint32_t cost[kSide * kStride];
  std::uint16_t rate[kSide * kStride];
  std::int32_t next;     ///< tile to look at, or kNoCell: all are done
  std::int32_t changed;  ///< which neighbours see a border that has changed: bit 3 (dj + 1) + di + 1 for the one (di,
                         ///< dj) beside it

  [[nodiscard]] JAYWALK_CELL static std::int32_t at(std::int32_t i, std::int32_t j) { return j * kStride + i; }
  [[nodiscard]] JAYWALK_CELL static bool holds(std::int32_t i, std::int32_t j) {
    return i >= 0 && j >= 0 && i < kSide && j < kSide;
  }
};

/// What a step along a line adds to a cost; 0: there is none. `a` and `b` are the cells beside both.
JAYWALK_CELL std::uint32_t step_cost(bool straight, std::uint32_t from, std::uint32_t to, std::uint32_t a,
                                     std::uint32_t b) {
  if (from == 0 || to == 0 || a == 0 || b == 0) return 0;
  return straight ? cell::straight_step(from, to) : cell::diagonal_step(from, to, a, b);
}

/// Everything far but the goal, whose tile is to be looked at first; and each cell's rate.
struct BeginTiles {
  RateOfEachCell rate;
  std::int32_t goal;
  std::uint32_t* cost;
  StartTiles tiles;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t c = rate.grid.at(i, j);
    rate(i, j);
    cost[c] = c == goal ? 0U : kNoWay;
    if (c < StartTiles::count(rate.grid)) tiles.waits[c] = c == StartTiles::of_cell(rate.grid, goal) ? 1 : 0;
    if (c == 0) *tiles.pending = 1;
  }
};

template <class Place>
class TileSettler {
 public:
  JAYWALK_ORDER TileSettler(const Place& place, Grid grid, std::int32_t goal, const FieldArrays& a)
      : place_(place), grid_(grid), goal_(goal), a_(a), tile_(*static_cast<StartTile*>(place.memory())) {}

  /// The stage before it, a cell each.
  [[nodiscard]] JAYWALK_ORDER static BeginTiles beginning(Grid grid, std::int32_t goal, const FieldArrays& a) {
    return {{grid, a.clearance, a.table, a.rate}, goal, a.cost, a.tiles};
  }
  /// Until no tile waits anywhere. What others have settled is there once the crew has met.
  JAYWALK_APART void settle() const {
    for (;;) {
      if (place_.block_thread() == 0) tile_.next = awaited();
      place_.meet_block();
      const std::int32_t tile = tile_.next;
      if (tile == kNoCell) return;
      look_after(tile);
    }
  }

 private:
  static constexpr std::int32_t kSide = StartTile::kSide;
  static constexpr std::int32_t kWays = 8;

  /// A tile of this block's that waits; kNoCell once none waits anywhere nor is looked at. By one thread.
  [[nodiscard]] JAYWALK_ORDER std::int32_t awaited() const {
    for (;;) {
      for (std::int32_t t = place_.block(); t < StartTiles::count(grid_); t += place_.blocks()) {
        if (place_.peek(a_.tiles.waits + t) != 0 && place_.swap(a_.tiles.waits + t, 0) != 0) {
          place_.fence();
          return t;
        }
      }
      if (place_.peek(a_.tiles.pending) == 0) return kNoCell;
      place_.pause();
    }
  }

  JAYWALK_ORDER void look_after(std::int32_t tile) const {
    const std::int32_t tiles = grid_.side / kSide, i0 = tile % tiles * kSide, j0 = tile / tiles * kSide;
    fetch(i0, j0);
    bool falls = take_in(i0, j0) || tile == StartTiles::of_cell(grid_, goal_);
    while (place_.sum_of_block({falls ? 1 : 0, 0}).cells != 0) {
      falls = false;
      for (std::int32_t k = place_.block_thread(); k < kWays * kSide; k += place_.block_threads())
        falls |= relax_line(k / kSide, k % kSide);
    }
    store(i0, j0);
    tell(tile, tiles);
  }

  JAYWALK_ORDER void fetch(std::int32_t i0, std::int32_t j0) const {
    if (place_.block_thread() == 0) tile_.changed = 0;
    for (std::int32_t k = place_.block_thread(); k < kSide * kSide; k += place_.block_threads()) {
      const std::int32_t i = k % kSide, j = k / kSide, c = grid_.at(i0 + i, j0 + j);
      tile_.cost[StartTile::at(i, j)] = place_.peek(a_.cost + c);
      tile_.rate[StartTile::at(i, j)] = a_.rate[c];
    }
    place_.meet_block();
  }

  /// Steps from outside to the tile's border. Whether one made a cost fall.
  JAYWALK_ORDER bool take_in(std::int32_t i0, std::int32_t j0) const {
    bool falls = false;
    JAYWALK_ROLLED
    for (std::int32_t k = place_.block_thread(); k < 4 * kSide; k += place_.block_threads()) {
      const std::int32_t p = k % kSide, far = (k & kSide) != 0 ? kSide - 1 : 0;
      const std::int32_t i = k < 2 * kSide ? p : far, j = k < 2 * kSide ? far : p;
      JAYWALK_ROLLED
      for (std::int32_t way = 0; way < 9; ++way) {
        const std::int32_t di = way % 3 - 1, dj = way / 3 - 1;
        if (!StartTile::holds(i + di, j + dj) && grid_.holds(i0 + i + di, j0 + j + dj))
          falls |= take_step(i, j, grid_.at(i0 + i, j0 + j), di, dj);
      }
    }
    return falls;
  }

  /// To cell (i, j) of the tile, which is cell `to` of the grid, from the one (di, dj) beside it.
  JAYWALK_ORDER bool take_step(std::int32_t i, std::int32_t j, std::int32_t to, std::int32_t di,
                               std::int32_t dj) const {
    const std::int32_t from = to + dj * grid_.side + di;
    const std::uint32_t before = place_.peek(a_.cost + from);
    const std::uint32_t step =
        step_cost(di == 0 || dj == 0, a_.rate[from], a_.rate[to], a_.rate[to + dj * grid_.side], a_.rate[to + di]);
    std::uint32_t* cost = tile_.cost + StartTile::at(i, j);
    if (step == 0 || before >= kFarthest || before + step >= place_.peek(cost)) return false;
    place_.lower(cost, before + step);
    return true;
  }

  /// All steps along a line of the tile one way. Whether one made a cost fall. (Two lines may meet in a cell: the lower
  /// cost stays.)
  JAYWALK_ORDER bool relax_line(std::int32_t way, std::int32_t line) const {
    const Along along{way < 2 ? 1 : (way < 4 ? 0 : (way < 6 ? 1 : -1)), way < 2 ? 0 : 1};
    const std::int32_t forth = (way & 1) == 0 ? 1 : -1;
    std::int32_t p = forth > 0 ? 0 : kSide - 1;
    std::int32_t i = column(along, line, p), j = along.dj == 0 ? line : p;
    std::uint32_t cost = place_.peek(tile_.cost + StartTile::at(i, j));
    bool falls = false;
    JAYWALK_ROLLED
    for (std::int32_t k = 1; k < kSide; ++k) {
      p += forth;
      const std::int32_t to_i = column(along, line, p), to_j = along.dj == 0 ? line : p, to = StartTile::at(to_i, to_j);
      const bool is_next = to_i - i == forth * along.di;  // diagonals go on at the tile's other side without a step
      const std::uint32_t step =
          step_cost(along.di == 0 || along.dj == 0, tile_.rate[StartTile::at(i, j)], tile_.rate[to],
                    tile_.rate[StartTile::at(to_i, j)], tile_.rate[StartTile::at(i, to_j)]);
      const std::uint32_t there = place_.peek(tile_.cost + to);
      const bool falls_here = is_next && step != 0 && cost < kFarthest && cost + step < there;
      cost = falls_here ? cost + step : there;
      if (falls_here) place_.lower(tile_.cost + to, cost);
      falls |= falls_here;
      i = to_i, j = to_j;
    }
    return falls;
  }
  [[nodiscard]] JAYWALK_ORDER static std::int32_t column(Along along, std::int32_t line, std::int32_t p) {
    return along.dj == 0 ? p : (line + along.di * p) & (kSide - 1);
  }

  JAYWALK_ORDER void store(std::int32_t i0, std::int32_t j0) const {
    std::int32_t changed = 0;
    for (std::int32_t k = place_.block_thread(); k < kSide * kSide; k += place_.block_threads()) {
      const std::int32_t i = k % kSide, j = k / kSide, c = grid_.at(i0 + i, j0 + j);
      const std::uint32_t cost = tile_.cost[StartTile::at(i, j)];
      if (cost == place_.peek(a_.cost + c)) continue;
      place_.put(a_.cost + c, cost);
      for (std::int32_t way = 0; way < 9; ++way)
        changed |= StartTile::holds(i + way % 3 - 1, j + way / 3 - 1) ? 0 : 1 << way;
    }
    if (changed != 0) place_.set_bits(&tile_.changed, changed);
    place_.fence();
    place_.meet_block();
  }

  /// Neighbours that see a changed border wait from now on; this tile is done.
  JAYWALK_ORDER void tell(std::int32_t tile, std::int32_t tiles) const {
    for (std::int32_t way = place_.block_thread(); way < 9; way += place_.block_threads()) {
      const std::int32_t i = tile % tiles + way % 3 - 1, j = tile / tiles + way / 3 - 1;
      if ((tile_.changed & (1 << way)) == 0 || !Grid{tiles}.holds(i, j)) continue;
      if (place_.swap(a_.tiles.waits + Grid{tiles}.at(i, j), 1) == 0) (void)place_.add(a_.tiles.pending, 1);
    }
    place_.meet_block();
    if (place_.block_thread() == 0) (void)place_.add(a_.tiles.pending, -1);
  }

  const Place& place_;
  Grid grid_;
  std::int32_t goal_;
  const FieldArrays& a_;
  StartTile& tile_;
};

}  // namespace jaywalk::field
