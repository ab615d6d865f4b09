#pragma once
// The solver's cycles (multigrid.h) by a crew: the same stages in the same order, and the same bits, with few meetings.
// Every block owns a strip of each level's rows. Of x, which is what sweeps change, it has an array of its own: it
// fetches as many of its neighbours' rows as the sweeps to come look at, relaxes those as well, a row less a half
// sweep, and meets the crew for one exchange where meeting after each half sweep would be many. Levels of few cells
// each block relaxes whole, by itself. All other arrays are the crew's: they are written by their rows' owner alone.
#include "planner/field/crew.h"
#include "planner/field/multigrid.h"

namespace jaywalk::field {

/// One colour of x, given to others or taken from them: visits rows.
struct CopyColour {
  Board board;
  std::int32_t colour;
  const float* from;
  float* to;

  JAYWALK_CELL void operator()(std::int32_t h, std::int32_t j) const {
    const std::int32_t c = board.row(colour, j) + h;
    to[c] = from[c];
  }
};

/// Both colours of x begin from 0.
struct ClearRow {
  Board board;
  float* x;

  JAYWALK_CELL void operator()(std::int32_t h, std::int32_t j) const {
    x[board.row(0, j) + h] = 0.0F;
    x[board.row(1, j) + h] = 0.0F;
  }
};

template <class Place>
class StripCycles {
 public:
  JAYWALK_ORDER StripCycles(Crew<Place>& crew, const MultigridArrays& arrays)
      : crew_(crew),
        place_(crew.place()),
        counted_(arrays.counted),
        levels_(arrays.of_blocks + place_.block() * kMostLevels) {}

  /// As Multigrid::improve. The crew has not met since `last`: its total_of_rows is to follow.
  template <class First, class... Last>
  JAYWALK_APART std::int32_t improve(Grid grid, std::int32_t goal, float* psi, Cycles wanted, const First& first,
                                     const Last&... last) noexcept {
    side_ = grid.side;
    crew_.meet();
    set_up(goal, psi, first);
    if (wanted.least == 0) place_.meet_crew();
    std::int32_t cycles = 0;
    for (bool enough = wanted.least == 0; !enough;) {
      cycle(cycles == 0);
      ++cycles;
      // The next cycle changes couplings that others may still be relaxing by: the crew meets either way.
      const bool asks = cycles >= wanted.least && cycles < wanted.most;
      enough = asks ? is_settled() : cycles >= wanted.most;
      if (!asks) place_.meet_crew();
    }
    take_psi(psi);
    (visit(last.width, own(side_), last.stage), ...);
    return cycles;
  }

 private:
  using Rules = CycleRules;
  /// Rows that a strip is relaxed beyond its own at most: a chain of as many half sweeps between two meetings. By
  /// reckoning: four times the cells of a strip of eight rows then take about as long as a meeting.
  static constexpr std::int32_t kMostHalo = 16;
  /// Half sweeps on the way down, and on the way back before the further ones.
  static constexpr std::int32_t kHalves = 4;

  [[nodiscard]] JAYWALK_ORDER bool is_whole(std::int32_t side) const { return side <= Strips::whole_side(side_); }
  /// The rows that this block owns on a level; of those that are relaxed whole all are the first block's.
  [[nodiscard]] JAYWALK_ORDER Rows own(std::int32_t side) const {
    if (is_whole(side)) return {0, side};
    return Strips::of_block(side_, side, place_.block(), place_.blocks());
  }
  [[nodiscard]] JAYWALK_ORDER static Sources sources_of(const LevelArrays& a, std::int32_t side) {
    return {a.source, 0, side - 1};
  }
  /// Of a board's rows, on the way back, that are corrected: as many as the sweeps after it want.
  [[nodiscard]] JAYWALK_ORDER static std::int32_t halo_back(std::int32_t depth) {
    const std::int32_t wanted = kHalves + 2 * Rules::further_sweeps(depth) + beyond(depth);
    return wanted < kMostHalo ? wanted : kMostHalo;
  }
  /// Rows beyond its own that a strip of cells wants relaxed: neighbours' are asked for what has been tilted.
  [[nodiscard]] JAYWALK_ORDER static std::int32_t beyond(std::int32_t depth) { return depth == 0 ? 1 : 0; }

  /// The block's threads visit these rows, and meet.
  template <class Stage>
  JAYWALK_ORDER void visit(std::int32_t width, Rows rows, const Stage& stage) const {
    const std::int32_t last = width - 1, log2 = Place::log2_of(width), n = width * (rows.high - rows.low);
    JAYWALK_ROLLED
    for (std::int32_t k = place_.block_thread(); k < n; k += place_.block_threads())
      stage(k & last, rows.low + (k >> log2));
    place_.meet_block();
  }

  /// x of the strip's own rows, for others to take once the crew has met.
  JAYWALK_APART void hand_over(std::int32_t depth, std::int32_t side) {
    const LevelArrays& a = levels_[depth];
    for (std::int32_t colour = 0; colour < 2; ++colour)
      visit(side / 2, own(side), CopyColour{{side}, colour, a.x, a.handed[turn_]});
  }
  JAYWALK_ORDER void meet() {
    place_.meet_crew();
    turn_ = 1 - turn_;
  }
  /// What the neighbours handed over before the crew met last.
  JAYWALK_APART void take(std::int32_t depth, std::int32_t side, std::int32_t by) {
    const LevelArrays& a = levels_[depth];
    const Rows mine = own(side), wide = mine.wider(by, side);
    for (std::int32_t colour = 0; colour < 2; ++colour) {
      const CopyColour copy{{side}, colour, a.handed[1 - turn_], a.x};
      visit(side / 2, {wide.low, mine.low}, copy);
      visit(side / 2, {mine.high, wide.high}, copy);
    }
  }
  JAYWALK_ORDER void exchange(std::int32_t depth, std::int32_t side, std::int32_t by) {
    hand_over(depth, side);
    meet();
    take(depth, side, by);
  }

  template <class First>
  JAYWALK_APART void set_up(std::int32_t goal, float* psi, const First& first) {
    const LevelArrays& a = levels_[0];
    const Board board{side_};
    const std::int32_t half = board.half();
    const Rows mine = own(side_);
    visit(first.width, mine, first.stage);
    visit(half, mine, ToBoard{board, psi, a.psi});
    place_.meet_crew();
    if (mine.low == mine.high) return;
    for (std::int32_t colour = 0; colour < 2; ++colour)
      visit(half, mine, CoupleAhead{board, colour, a.psi, a.couplings, sources_of(a, side_), a.x});
    for (std::int32_t colour = 0; colour < 2; ++colour) {
      // What lies south of the first row is another block's, and may not be there yet.
      visit(half, {mine.low, mine.low + 1}, CoupleBack<true>{board, colour, a.psi, a.couplings});
      visit(half, {mine.low + 1, mine.high}, CoupleBack<>{board, colour, a.psi, a.couplings});
    }
    if (place_.block_thread() == 0) SettleGoal{board, goal, a.couplings, a.source, mine.low, mine.high}(0);
    place_.meet_block();
  }

  /// As Multigrid::cycle, which goes down and back twice on a large board.
  JAYWALK_ORDER void cycle(bool first) {
    std::int32_t depth = 0, side = side_, lowest = kMostLevels;
    if (first) used_ = kMostLevels;
    bool again = false;
    do {
      for (; !is_whole(side) && depth < lowest; ++depth, side /= 2) {
        if (!again && depth == 0 && !first) rebase();
        if (!again) depth == 0 ? build<true>(depth, side) : build<false>(depth, side);
        go_down(depth, side, depth > (again ? 1 : 0));
        if (!again && is_last(first, depth, side)) break;
      }
      lowest = depth;
      solve_lowest(depth, side, first && !again, !again);
      again = !again && side_ > kLargeSide && lowest > Rules::kBulkyDepth;
      climb(depth, side, again ? 1 : 0);
    } while (again);
  }

  /// Whether no level above this one's is of use.
  JAYWALK_ORDER bool is_last(bool first, std::int32_t depth, std::int32_t side) {
    if (first && depth >= Rules::kBulkyDepth && !speaks_for_most(depth + 1, side / 2)) used_ = depth + 1;
    return depth + 1 >= used_;
  }

  /// The lowest level that is relaxed in strips, or all that are relaxed whole.
  JAYWALK_ORDER void solve_lowest(std::int32_t depth, std::int32_t side, bool first, bool builds) {
    if (!is_whole(side)) return relax_on(depth, side, 2 * Rules::further_sweeps(depth), 0);
    if (place_.in_first_block()) {
      solve_whole(depth, side, first, builds);
      hand_over(depth, side);
    }
    meet();
    if (place_.in_first_block()) return;
    for (std::int32_t colour = 0; colour < 2; ++colour)
      visit(side / 2, own(side), CopyColour{{side}, colour, levels_[depth].handed[1 - turn_], levels_[depth].x});
  }

  /// Down to the lowest level of use and back, by one block.
  JAYWALK_APART void solve_whole(std::int32_t top, std::int32_t side, bool first, bool builds) {
    std::int32_t depth = top;
    for (; side > kCoarsestSide; ++depth, side /= 2) {
      if (builds) build<false>(depth, side);
      go_down(depth, side, true);
      if (is_last(first, depth, side)) break;
    }
    const std::int32_t further = side > kCoarsestSide ? Rules::further_sweeps(depth) : Rules::kCoarsestSweeps;
    relax(depth, side, 2 * further, 0);
    climb(depth, side, top);
  }

  JAYWALK_APART void rebase() {
    const LevelArrays& a = levels_[0];
    const Board board{side_};
    for (std::int32_t colour = 0; colour < 2; ++colour)
      visit(board.half(), own(side_), RebaseCouplings{board, colour, a.x, a.couplings, sources_of(a, side_)});
    for (std::int32_t colour = 0; colour < 2; ++colour)
      visit(board.half(), own(side_), RebasePsi{board, colour, a.x, a.psi});
  }

  /// The blocks' equations. (They are whole where the cells' rows are.)
  template <bool kFinest>
  JAYWALK_APART void build(std::int32_t depth, std::int32_t side) {
    const LevelArrays& a = levels_[depth];
    const LevelArrays& b = levels_[depth + 1];
    const Board blocks{side / 2};
    const Rows mine = own(side).blocks();
    visit(blocks.side, mine, CoarsenBlock<kFinest>{{{side}, a.couplings, a.psi, a.diagonal}, blocks.side, b.rows});
    visit(blocks.half(), mine, BlocksToBoard{blocks, b.rows, b.couplings, b.psi, b.diagonal});
  }

  /// Relaxes twice, and hands on what is lacking. `fresh`: x is 0 in all rows, others' too.
  JAYWALK_ORDER void go_down(std::int32_t depth, std::int32_t side, bool fresh) {
    const bool alone = is_whole(side), next_is_whole = is_whole(side / 2);
    if (!alone && !fresh) exchange(depth, side, kHalves + 1);
    relax(depth, side, kHalves, 1);
    restrict_to_blocks(depth, side);
    if (alone) return;
    if (next_is_whole) hand_over(depth, side);
    meet();
    if (next_is_whole) take(depth, side, halo_back(depth));
  }

  JAYWALK_APART void restrict_to_blocks(std::int32_t depth, std::int32_t side) {
    const LevelArrays& a = levels_[depth];
    const LevelArrays& b = levels_[depth + 1];
    const Board board{side}, blocks{side / 2};
    const Rows mine = own(side).blocks();
    visit(blocks.side, mine,
          RestrictToBlock{{board, a.couplings, a.psi, a.diagonal}, sources_of(a, side), a.x, blocks.side, b.rows});
    visit(blocks.half(), own(blocks.side).wider(kHalves + 1, blocks.side), ClearRow{blocks, b.x});
    visit(blocks.half(), mine, LackingToBoard{blocks, b.rows.lacking, b.source, b.x});
  }

  /// So many half sweeps, the last of them of the rows that the block owns and `extra` on either side.
  JAYWALK_APART void relax(std::int32_t depth, std::int32_t side, std::int32_t halves, std::int32_t extra) {
    const LevelArrays& a = levels_[depth];
    const Rows mine = own(side);
    for (std::int32_t k = 0; k < halves; ++k) {
      visit(side / 2, mine.wider(halves - 1 - k + extra, side),
            RelaxColour{{side}, k & 1, a.couplings, sources_of(a, side), a.x});
    }
  }

  /// The same of any number, x being right in `valid` rows on either side.
  JAYWALK_ORDER void relax_on(std::int32_t depth, std::int32_t side, std::int32_t halves, std::int32_t valid) {
    const std::int32_t extra = beyond(depth);
    if (is_whole(side)) return relax(depth, side, halves, 0);
    while (halves > 0) {
      if (valid <= extra) exchange(depth, side, kMostHalo), valid = kMostHalo;
      const std::int32_t some = (valid - extra) & ~1, now = halves < some ? halves : some;
      relax(depth, side, now, extra);
      halves -= now, valid = extra;
    }
  }

  JAYWALK_ORDER void climb(std::int32_t& depth, std::int32_t& side, std::int32_t top) {
    while (depth > top) {
      --depth, side *= 2;
      go_up(depth, side);
    }
  }

  /// Adds what the blocks have found, and relaxes.
  JAYWALK_ORDER void go_up(std::int32_t depth, std::int32_t side) {
    const std::int32_t halo = halo_back(depth);
    if (!is_whole(side) && !is_whole(side / 2)) {
      hand_over(depth, side), hand_over(depth + 1, side / 2);
      meet();
      take(depth, side, halo), take(depth + 1, side / 2, halo / 2 + 2);
    }
    depth == 0 ? prolong<true>(depth, side, halo) : prolong<false>(depth, side, halo);
    relax_on(depth, side, kHalves + 2 * Rules::further_sweeps(depth), halo);
  }

  template <bool kFinest>
  JAYWALK_APART void prolong(std::int32_t depth, std::int32_t side, std::int32_t halo) {
    const LevelArrays& a = levels_[depth];
    const LevelArrays& b = levels_[depth + 1];
    const Board blocks{side / 2};
    const Rows wide = own(side).wider(halo, side);
    const Rows asked = Rows{wide.low / 2, (wide.high + 1) / 2}.wider(1, blocks.side);
    visit(blocks.half(), asked, FromBoard{blocks, b.x, b.correction});
    for (std::int32_t colour = 0; colour < 2; ++colour)
      visit(side / 2, wide, ProlongToCell<kFinest>{blocks.side, b.rows.ties, b.correction, {side}, colour, a.x});
  }

  JAYWALK_APART bool speaks_for_most(std::int32_t depth, std::int32_t side) {
    const Rows rows = own(2 * side).blocks();
    visit(1, rows, SpokenOfRow{side, levels_[depth - 1].rows.diagonal, levels_[depth].rows.ties, counted_});
    const Counted spoken = is_whole(2 * side) ? crew_.total_of_block(rows.low, rows.high, counted_)
                                              : crew_.total_of_parts(rows.low, rows.high, counted_);
    return Rules::is_spoken_for(spoken);
  }

  JAYWALK_APART bool is_settled() {
    const std::int32_t cells = cells_of_row<Crew<Place>>(side_), pieces = side_ / cells;
    const Rows rows = own(side_);
    visit(pieces, rows, TiltedOfRow{{side_}, cells, Rules::kTilt, levels_[0].x, counted_});
    return Rules::is_settled(crew_.total_of_parts(pieces * rows.low, pieces * rows.high, counted_));
  }

  JAYWALK_APART void take_psi(float* psi) {
    const LevelArrays& a = levels_[0];
    const Board board{side_};
    for (std::int32_t colour = 0; colour < 2; ++colour)
      visit(board.half(), own(side_), RebasePsi{board, colour, a.x, a.psi});
    visit(board.half(), own(side_), FromBoard{board, a.psi, psi});
    place_.meet_crew();
  }

  Crew<Place>& crew_;
  const Place& place_;
  Counted* counted_;
  const LevelArrays* levels_;  ///< the block's
  std::int32_t side_ = 0;
  std::int32_t used_ = 0;  ///< levels that are of use on this map
  std::int32_t turn_ = 0;  ///< which of two places x is handed over in
};

}  // namespace jaywalk::field
