#pragma once
// An executor of many threads. Each of them runs the whole order and visits its share of every step; where a step ends
// they meet. What the order chooses by it asks of `total`, whose answer is one for all: so all take the same way
// through the order and meet as often. Steps on small boards the first block takes alone, and meets only itself: a
// block's threads meet in a tenth of the time, and its processor keeps at hand what it has written. The other blocks go
// on to where the crew meets next.
//
// Place says where a thread stands and how it meets others. A meeting orders memory among those who meet.
//   thread(), threads()              its number in the crew, and how many there are
//   block_thread(), block_threads()  the same in its block
//   block(), blocks(), in_first_block()
//   most_alone()                     cells of a step that the first block takes alone, the same for all
//   log2_of(n)                       of a power of two
//   meet_crew(), meet_block()
//   sum_of_block(counted)            what its block's threads hand over, in all; they meet
//   memory()                         the block's own, room for a StartTile
//   peek(at), put(at, value)         what others may write or read meanwhile
//   lower(at, value), set_bits(at, bits)            in the block's memory, by several threads at a time
//   swap(at, value), add(at, value), fence()        among the crew: what was before; a fence before it is told
//   pause()                          for others to get on
#include "planner/field/executor.h"
#include "planner/mapping/grid.h"

namespace jaywalk::field {

/// Blocks that a crew has at most: strips of a level of 64 rows (strips.h).
inline constexpr std::int32_t kMostBlocks = 64;

/// What a crew's threads tell one another; the executor's memory.
struct CrewNotes {
  Counted* sums;  ///< kRoom
  Counted* told;  ///< kTold: by blocks, twice, in turn: one may still be read while the next is written
  static constexpr std::size_t kTold = 2 * static_cast<std::size_t>(kMostBlocks);
  /// Parts that a long sum is taken in, first and then: as many as a block has threads, and few enough for one.
  static constexpr std::int32_t kMany = 512, kFew = 16;
  static constexpr std::size_t kRoom = kMany + kFew;
};

/// Rows [low, high).
struct Rows {
  std::int32_t low, high;

  [[nodiscard]] JAYWALK_CELL Rows wider(std::int32_t by, std::int32_t side) const {
    return {low > by ? low - by : 0, high + by < side ? high + by : side};
  }
  /// Of the blocks of 2 x 2 cells that these rows of cells are.
  [[nodiscard]] JAYWALK_CELL Rows blocks() const { return {low / 2, high / 2}; }
};

/// The strips of rows that a grid of `grid_side` cells a side, and the levels above it, are shared out in.
struct Strips {
  /// The largest level that the first block relaxes alone: one row of it is the least that a strip is made of.
  [[nodiscard]] JAYWALK_CELL static std::int32_t whole_side(std::int32_t grid_side) {
    return grid_side / 2 < kMostBlocks ? grid_side / 2 : kMostBlocks;
  }
  /// A block's rows of a larger level, or of the grid.
  [[nodiscard]] JAYWALK_CELL static Rows of_block(std::int32_t grid_side, std::int32_t side, std::int32_t block,
                                                  std::int32_t blocks) {
    const std::int32_t rows = whole_side(grid_side), each = (rows + blocks - 1) / blocks, times = side / rows;
    const std::int32_t low = block * each, high = low + each;
    return {(low < rows ? low : rows) * times, (high < rows ? high : rows) * times};
  }
};

/// Visit k adds up the k-th value, the one `stride` after it, and so on.
struct SumOf {
  std::int32_t n, stride;
  const Counted* counted;
  Counted* sums;

  JAYWALK_CELL void operator()(std::int32_t k) const {
    Counted sum;
    for (std::int32_t c = k; c < n; c += stride) sum.cells += counted[c].cells, sum.joined += counted[c].joined;
    sums[k] = sum;
  }
};

/// Cells that a visit takes: what the stage says, else one.
template <class Stage>
[[nodiscard]] JAYWALK_CELL std::int32_t cells_of_visit(const Stage& stage) {
  if constexpr (requires { stage.cells_of_visit(); }) {
    return stage.cells_of_visit();
  } else {
    return 1;
  }
}

template <class Place>
class StripCycles;
template <class Place>
class TileSettler;

template <class Place>
class Crew {
 public:
  using Solver = StripCycles<Place>;
  static constexpr std::int32_t kColumns = kOneCell;
  static constexpr std::int32_t kCellsOfRow = 16;
  static constexpr bool kInTurn = false;

  JAYWALK_ORDER Crew(const Place& place, const CrewNotes& notes) : place_(place), notes_(notes) {}

  [[nodiscard]] JAYWALK_ORDER const Place& place() const noexcept { return place_; }

  template <class Stage>
  JAYWALK_ORDER void for_each(std::int32_t n, const Stage& stage) noexcept {
    step(n, cells_of_visit(stage), stage);
  }

  template <class Stage>
  JAYWALK_ORDER void hand_out(std::int32_t n, const Stage& stage) noexcept {
    meet();
    visit(place_.thread(), place_.threads(), n, stage);
  }

  /// w is a power of two.
  template <class Stage>
  JAYWALK_ORDER void for_each_cell(std::int32_t w, std::int32_t h, const Stage& stage) noexcept {
    if (w > 0) step(w * h, cells_of_visit(stage), OnCells<Stage>{w - 1, Place::log2_of(w), stage});
  }

  template <class... Steps>
  JAYWALK_ORDER void for_each_row(std::int32_t h, const Steps&... steps) noexcept {
    (for_each_cell(steps.width, h / steps.every, steps.stage), ...);
  }

  template <class... Steps>
  JAYWALK_ORDER void repeat(std::int32_t n, std::int32_t h, const Steps&... steps) noexcept {
    for (std::int32_t k = 0; k < n; ++k) for_each_row(h, steps...);
  }

  /// By tiles.
  template <class Arrays>
  JAYWALK_ORDER void settle(Grid grid, std::int32_t goal, const Arrays& a) noexcept {
    for_each_cell(grid.side, grid.side, TileSettler<Place>::beginning(grid, goal, a));
    meet();
    TileSettler<Place>(place_, grid, goal, a).settle();
    // All has been settled: for processors whose caches hold older costs.
    place_.meet_crew();
  }

  JAYWALK_APART Counted total(std::int32_t n, const Counted* counted) noexcept {
    constexpr std::int32_t kMany = CrewNotes::kMany, kFew = CrewNotes::kFew;
    const Counted* last = counted;
    if (n > kFew) {
      for_each(kMany, SumOf{n, kMany, counted, notes_.sums});
      for_each(kFew, SumOf{kMany, kFew, notes_.sums, notes_.sums + kMany});
      last = notes_.sums + kMany;
    }
    Counted* told = notes_.told + turn_ * kMostBlocks;
    turn_ = 1 - turn_;
    if (place_.thread() == 0) SumOf{n > kFew ? kFew : n, 1, last, told}(0);
    apart_ = true;
    meet();
    return told[0];
  }

  /// The sums of `width` pairs a row of a grid, which strips or steps have counted.
  [[nodiscard]] JAYWALK_ORDER Counted total_of_rows(std::int32_t side, std::int32_t width,
                                                    const Counted* counted) noexcept {
    const Rows rows = Strips::of_block(side, side, place_.block(), place_.blocks());
    meet();
    return total_of_parts(width * rows.low, width * rows.high, counted);
  }
  /// The sums of [first, last), which is the part that this block's threads have counted: for the block.
  [[nodiscard]] JAYWALK_APART Counted total_of_block(std::int32_t first, std::int32_t last,
                                                     const Counted* counted) const noexcept {
    Counted mine;
    JAYWALK_ROLLED
    for (std::int32_t k = first + place_.block_thread(); k < last; k += place_.block_threads())
      mine.cells += counted[k].cells, mine.joined += counted[k].joined;
    return place_.sum_of_block(mine);
  }
  /// Of all blocks' parts.
  [[nodiscard]] JAYWALK_APART Counted total_of_parts(std::int32_t first, std::int32_t last,
                                                     const Counted* counted) noexcept {
    const Counted mine = total_of_block(first, last, counted);
    Counted* told = notes_.told + turn_ * kMostBlocks;
    turn_ = 1 - turn_;
    if (place_.block_thread() == 0) told[place_.block()] = mine;
    place_.meet_crew();
    Counted all;
    JAYWALK_ROLLED
    for (std::int32_t k = 0; k < place_.blocks(); ++k) all.cells += told[k].cells, all.joined += told[k].joined;
    return all;
  }

  /// The crew meets if its first block has gone on alone.
  JAYWALK_ORDER void meet() noexcept {
    if (apart_) place_.meet_crew();
    apart_ = false;
  }

 private:
  template <class Stage>
  struct OnCells {
    std::int32_t last_column, log2_of_width;
    const Stage& stage;
    JAYWALK_CELL void operator()(std::int32_t k) const { stage(k & last_column, k >> log2_of_width); }
  };

  template <class Visit>
  JAYWALK_ORDER void step(std::int32_t visits, std::int32_t cells, const Visit& visit) noexcept {
    if (visits <= 0) return;
    const bool alone = visits * cells <= place_.most_alone();
    if (!alone) meet();
    if (alone) apart_ = true;
    if (alone && !place_.in_first_block()) return;
    Crew::visit(alone ? place_.block_thread() : place_.thread(), alone ? place_.block_threads() : place_.threads(),
                visits, visit);
    alone ? place_.meet_block() : place_.meet_crew();
  }

  /// One thread's share.
  template <class Visit>
  JAYWALK_APART static void visit(std::int32_t first, std::int32_t stride, std::int32_t visits,
                                  const Visit& visit) noexcept {
    JAYWALK_ROLLED
    for (std::int32_t k = first; k < visits; k += stride) visit(k);
  }

  Place place_;
  CrewNotes notes_;
  std::int32_t turn_ = 0;
  bool apart_ = false;  ///< the first block has gone on alone since the crew has met
};

}  // namespace jaywalk::field
