#pragma once
// What planner/field/pass.h works on, and what comes of it.
#include <algorithm>
#include <cstddef>
#include <vector>

#include "planner/field/clearance_stages.h"
#include "planner/field/executor.h"
#include "planner/field/mark_stages.h"
#include "planner/field/path_stages.h"
#include "planner/field/start_field.h"
#include "planner/tracking/track.h"

namespace jaywalk::field {

/// Most cells that a raw path may have; a longer one is cut there, and leads towards the goal.
inline constexpr std::int32_t kMaxBandPoints = 16384;

/// What a solution begins from.
enum class From : std::uint8_t {
  kLast,       ///< the last one, which must have been on the same cells with the same goal
  kNothing,    ///< the start field
  kStartOnly,  ///< the start field, and leave it at that
};

/// How the potential came out.
struct FieldQuality {
  bool done = false;  ///< the executor has not failed
  bool certified = false;
  std::int32_t pits = 0;    ///< joined cells without a lower neighbour
  std::int32_t joined = 0;  ///< cells that the goal can be reached from; 0: not from the robot's place
  std::int32_t cycles = 0;
};

/// What host and stages both read and write. Where they share their memory these are the stages' own arrays.
struct ShownArrays {
  std::uint8_t* occupants;
  Mover* movers;
  Mark* marks;
  float* clearance;
  std::uint8_t* index;
  cell::Point* points;
};

/// What the stages read and write; all of it the executor's memory. A pointer an array,
/// and kernels take it whole: more fields than a struct has elsewhere.
struct FieldArrays {
  std::uint8_t* occupants;
  float* warp;
  Mover* movers;
  Mark* marks;
  std::uint32_t* columns;  ///< a bit a cell
  std::int32_t *rows_away, *envelope, *stretch;
  float* clearance;
  float *start_psi, *correction;
  std::uint16_t *table, *rate;
  std::uint32_t* cost;
  std::uint8_t* index;
  Counted* pits;  ///< by pieces of rows
  cell::Point *points, *raw_points;
  std::int32_t* moved;         ///< in which step each of the band's points did last
  double *segments, *lengths;  ///< of the band; of the raw path and the band
  ShownArrays shown;
};

/// Memory for grids up to `max_side` cells.
template <class Executor>
[[nodiscard]] FieldArrays take_field(Executor& executor, std::int32_t max_side) {
  FieldArrays a{};
  const auto cells = static_cast<std::size_t>(Grid{max_side}.cells());
  const std::size_t pieces = std::max(pieces_of_grid<Executor>(max_side), static_cast<std::size_t>(max_side));
  const std::vector<std::uint16_t> table = rate_table(max_side);
  const auto take = [&executor]<class T>(T*& array, std::size_t n) { array = executor.template take<T>(n); };
  const auto share = [&]<class T>(T*& array, T*& shown, std::size_t n) {
    take(array, n);
    shown = executor.show(array, n);
  };
  share(a.occupants, a.shown.occupants, cells);
  take(a.warp, cells);
  share(a.movers, a.shown.movers, kMaxTracks), share(a.marks, a.shown.marks, kMaxTracks);
  take(a.columns, cells / kRowsOfWord);
  take(a.rows_away, cells), take(a.envelope, cells), take(a.stretch, cells);
  share(a.clearance, a.shown.clearance, cells);
  take(a.start_psi, cells), take(a.correction, cells);
  take(a.table, table.size()), take(a.rate, cells), take(a.cost, cells);
  share(a.index, a.shown.index, cells);
  take(a.pits, pieces);
  share(a.points, a.shown.points, static_cast<std::size_t>(kMaxBandPoints));
  take(a.raw_points, static_cast<std::size_t>(kMaxBandPoints));
  take(a.moved, static_cast<std::size_t>(kMaxBandPoints));
  take(a.segments, static_cast<std::size_t>(kMaxBandPoints)), take(a.lengths, 2);
  executor.fill(a.table, table.data(), table.size());
  return a;
}

}  // namespace jaywalk::field
