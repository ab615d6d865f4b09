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
//   in_first_block()
//   most_alone()                     cells of a step that the first block takes alone, the same for all
//   log2_of(n)                       of a power of two
//   meet_crew(), meet_block()
#include "planner/field/executor.h"

namespace jaywalk::field {

/// What a crew's threads tell one another; the executor's memory.
struct CrewNotes {
  Counted* sums;  ///< kRoom
  Counted* told;  ///< two, in turn: one may still be read while the next is written
  /// Parts that a long sum is taken in, first and then: as many as a block has threads, and few enough for one.
  static constexpr std::int32_t kMany = 512, kFew = 16;
  static constexpr std::size_t kRoom = kMany + kFew;
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
class Crew {
 public:
  static constexpr std::int32_t kColumns = 1;
  static constexpr std::int32_t kCellsOfRow = 16;
  static constexpr bool kInTurn = false;

  JAYWALK_ORDER Crew(const Place& place, const CrewNotes& notes) : place_(place), notes_(notes) {}

  template <class Stage>
  JAYWALK_ORDER void for_each(std::int32_t n, const Stage& stage) noexcept {
    step(n, cells_of_visit(stage), stage);
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

  JAYWALK_ORDER Counted total(std::int32_t n, const Counted* counted) noexcept {
    constexpr std::int32_t kMany = CrewNotes::kMany, kFew = CrewNotes::kFew;
    const Counted* last = counted;
    if (n > kFew) {
      for_each(kMany, SumOf{n, kMany, counted, notes_.sums});
      for_each(kFew, SumOf{kMany, kFew, notes_.sums, notes_.sums + kMany});
      last = notes_.sums + kMany;
    }
    if (place_.thread() == 0) SumOf{n > kFew ? kFew : n, 1, last, notes_.told + turn_}(0);
    apart_ = true;
    meet();
    const Counted answer = notes_.told[turn_];
    turn_ = 1 - turn_;
    return answer;
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
    if (visits * cells <= place_.most_alone()) {
      apart_ = true;
      if (!place_.in_first_block()) return;
      for (std::int32_t k = place_.block_thread(); k < visits; k += place_.block_threads()) visit(k);
      place_.meet_block();
      return;
    }
    meet();
    for (std::int32_t k = place_.thread(); k < visits; k += place_.threads()) visit(k);
    place_.meet_crew();
  }

  JAYWALK_ORDER void meet() noexcept {
    if (apart_) place_.meet_crew();
    apart_ = false;
  }

  Place place_;
  CrewNotes notes_;
  std::int32_t turn_ = 0;
  bool apart_ = false;  ///< the first block has gone on alone since the crew has met
};

}  // namespace jaywalk::field
