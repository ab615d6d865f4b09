#pragma once
// Clearance where few columns of a row have another nearest obstacle than before: for executors of one thread, which
// keep what they have computed. Squared distances are integers, so the result is that of ClearanceOfRow, to the bit.
#include "planner/field/clearance_stages.h"
#include "planner/field/executor.h"

namespace jaywalk::field {

/// One row. Cells whose nearest obstacle was that of a column from which it has moved away look at all columns again;
/// those that it has come nearer to take it where it is nearest. Cells of `row.envelope` hold squared distances.
struct RepairClearanceOfRow {
  ClearanceOfRow row;                        ///< with the rows away as they are now
  const std::int32_t* before;                ///< rows away as they were
  static constexpr std::int32_t kFewOf = 4;  ///< columns that have changed, as a share of all: beyond it anew

  JAYWALK_CELL void operator()(std::int32_t j) const {
    const std::int32_t side = row.grid.side, first = row.grid.at(0, j);
    const std::int32_t *now = row.rows_away + first, *then = before + first;
    std::int32_t *squared = row.envelope + first, *changed = row.stretch + first, count = 0;
    for (std::int32_t u = 0; u < side; ++u) {
      changed[count] = u;
      count += now[u] != then[u] ? 1 : 0;
    }
    if (count == 0) return;
    if (count > side / kFewOf) return row(j);
    for (std::int32_t k = 0; k < count; ++k) {
      const std::int32_t u = changed[k];
      if (now[u] > then[u]) forget(u, then[u], squared);
    }
    for (std::int32_t i = 0; i < side; ++i) {
      if (squared[i] == kForgotten) squared[i] = nearest(now, i);
    }
    for (std::int32_t k = 0; k < count; ++k) {
      const std::int32_t u = changed[k];
      if (now[u] < then[u]) approach(u, now[u], squared);
    }
    for (std::int32_t i = 0; i < side; ++i) row.write(i, j, squared[i]);
  }

 private:
  static constexpr std::int32_t kForgotten = -1;

  /// Of the cells whose nearest obstacle may have been that of a column, g rows away.
  JAYWALK_CELL void forget(std::int32_t u, std::int32_t g, std::int32_t* squared) const {
    JAYWALK_INDEPENDENT_VISITS
    for (std::int32_t i = 0; i < row.grid.side; ++i) {
      const std::int32_t here = squared[i];
      squared[i] = here == cell::squared_distance(i, u, g) ? kForgotten : here;
    }
  }
  /// No column farther away than the obstacle of its own can be the nearest.
  [[nodiscard]] JAYWALK_CELL std::int32_t nearest(const std::int32_t* now, std::int32_t i) const {
    const std::int32_t reach = now[i], last = row.grid.side - 1;
    const std::int32_t from = i > reach ? i - reach : 0, to = i + reach < last ? i + reach : last;
    std::int32_t least = reach * reach;
    for (std::int32_t u = from; u <= to; ++u) {
      const std::int32_t there = cell::squared_distance(i, u, now[u]);
      least = there < least ? there : least;
    }
    return least;
  }
  JAYWALK_CELL void approach(std::int32_t u, std::int32_t g, std::int32_t* squared) const {
    JAYWALK_INDEPENDENT_VISITS
    for (std::int32_t i = 0; i < row.grid.side; ++i) {
      const std::int32_t there = cell::squared_distance(i, u, g);
      squared[i] = there < squared[i] ? there : squared[i];
    }
  }
};

}  // namespace jaywalk::field
