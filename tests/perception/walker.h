#pragma once
// A body that walked.
#include "planner/tracking/target.h"

namespace jaywalk::test {

using Sample = PositionHistory::Sample;

/// Samples `first` to `last` of a history, `step_s` apart.
template <class SampleAt>
PositionHistory history(int first, int last, const SampleAt& sample_at, double step_s = 0.1) {
  PositionHistory positions;
  for (int k = first; k <= last; ++k) positions.add(time_from_seconds(step_s * k), sample_at(k));
  return positions;
}

/// One who came from `from` to `to` in a second, seen ten times, 0.2 m wide, on ground that was free before.
inline Target walker(Vec2 from, Vec2 to) {
  Target target = born_at(from, 0.05, 0.1, time_from_seconds(0.0), 1);
  const Vec2 aside = Vec2{-(to - from).y, (to - from).x} * (0.1 / norm(to - from));
  for (int k = -2; k <= 2; ++k) (void)target.onset.anchor_outline.push_back(from + aside * (0.5 * k));
  for (int k = 1; k <= 10; ++k)
    target.onset.positions.add(time_from_seconds(0.1 * k),
                               {.where_in_map = from + (to - from) * (0.1 * k), .width_m = 0.2, .whole = true});
  for (const Vec2& p : target.onset.anchor_outline) (void)target.appearance.outline_in_map.push_back(p + to - from);
  target.estimate.track.position_in_map = to;
  target.estimate.track.velocity_in_map = to - from;
  target.estimate.track.covariance = {.pp = 0.002, .pv = 0.0, .vv = 0.04};
  target.onset.free_share = 1.0;
  target.appearance.whole = true;
  target.estimate.filter = ImmFilter(target.estimate.track);
  return target;
}

}  // namespace jaywalk::test
