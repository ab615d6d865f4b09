#pragma once
// Pulls the band taut: what the robot's path is.
#include "planner/field/executor.h"
#include "planner/field/field_arrays.h"
#include "planner/field/potential_stages.h"

namespace jaywalk::field {

/// Rounds of the band: enough for a corner to spread over its dozen neighbours.
inline constexpr std::int32_t kBandRounds = 60;
/// Rounds of tension alone between two looks at the band's length.
inline constexpr std::int32_t kTautRounds = 4;
/// Clearance (cells beyond inflation) below which things push the band: 0.5 m.
inline constexpr float kBandReach = 5.0F;

/// Pulls the band's `count` points taut; those before `first` and the last stay. The band is no longer than the raw
/// path: where what is near has made it so, tension alone draws it in, and where that takes too long, tension alone
/// acts on the raw path. Tension never lengthens: a point goes towards the middle of its neighbours. Steps are hundreds
/// of points or fewer: work for one block of threads.
struct PullInOneBlock {
  FieldArrays a;
  Grid grid;
  std::int32_t first, count;

  template <class Executor>
  JAYWALK_ORDER void operator()(Executor& executor) const noexcept {
    executor.for_each(count, Copy<cell::Point>{a.points, a.raw_points});
    executor.for_each(count, BeginBand{a.raw_points, a.points, a.moved});
    measure(executor, a.lengths);
    std::int32_t step = 0;
    drag(executor, kBandReach, kBandRounds, step, step);
    bool longer = is_longer(executor);
    for (std::int32_t r = 0, begun = step; r < kBandRounds && longer; r += kTautRounds) {
      drag(executor, 0.0F, kTautRounds, begun, step);
      longer = is_longer(executor);
    }
    if (longer) {
      executor.for_each(count, BeginBand{a.raw_points, a.points, a.moved});
      drag(executor, 0.0F, kBandRounds, step, step);
    }
  }

 private:
  /// Some rounds, from `step` on, of a force that began to act at step `begun`.
  template <class Executor>
  JAYWALK_APART void drag(Executor& executor, float reach, std::int32_t rounds, std::int32_t begun,
                          std::int32_t& step) const noexcept {
    for (const std::int32_t end = step + 3 * rounds; step < end; ++step) {
      const std::int32_t from = first + step % 3;
      executor.for_each((count - from + 1) / 3,
                        PullBand{grid, from, count, a.clearance, reach, begun, step, a.points, a.moved});
    }
  }

  template <class Executor>
  JAYWALK_ORDER void measure(Executor& executor, double* length) const noexcept {
    executor.for_each(count - 1, LengthOfSegment{a.points, a.segments});
    executor.for_each(1, LengthOfBand{count - 1, a.segments, length});
  }

  /// Than the raw path.
  template <class Executor>
  JAYWALK_ORDER bool is_longer(Executor& executor) const noexcept {
    measure(executor, a.lengths + 1);
    return a.lengths[1] > a.lengths[0];
  }
};

}  // namespace jaywalk::field
