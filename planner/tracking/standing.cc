#include "planner/tracking/standing.h"

#include <algorithm>

#include "planner/tracking/occlusion.h"

namespace jaywalk {
namespace {

/// Whether it is one of the targets, standing or about to go on.
bool is_tracked(const StandingPedestrian& pedestrian, const Targets& targets) {
  return std::any_of(targets.begin(), targets.end(), [&](const Target& target) {
    return target.existence.maybe_pedestrian &&
           distance(target.estimate.as_seen.position_in_map, pedestrian.position_in_map) < pedestrian.radius_m;
  });
}

bool something_stands(const StandingPedestrian& pedestrian, const EvidenceMap& still) {
  const Vec2 reach{kLegsReachM, kLegsReachM};
  const CellIndex low = still.cell_at(pedestrian.position_in_map - reach);
  const CellIndex high = still.cell_at(pedestrian.position_in_map + reach);
  for (std::int32_t j = low.j; j <= high.j; ++j) {
    for (std::int32_t i = low.i; i <= high.i; ++i) {
      if (!still.occupied({i, j})) continue;
      if (distance(still.surface({i, j}), pedestrian.position_in_map) < kLegsReachM) return true;
    }
  }
  return false;
}

/// No beam passes over its place, and it is not long since it was seen there.
bool may_be_hidden(const StandingPedestrian& pedestrian, const LineOfSight& sight, Time now) {
  const double unseen_s = to_seconds(now - pedestrian.last_seen);
  return unseen_s < kRememberedS && sight.at(pedestrian.position_in_map, kLegsReachM) != Sight::kThrough;
}

/// When something was seen last in its place: a pedestrian that comes into view again is born anew, and may show one
/// leg.
Time last_seen(const StandingPedestrian& pedestrian, const Targets& targets, Time now) {
  Time last = pedestrian.last_seen;
  for (const Target& target : targets) {
    const Track& seen = target.estimate.as_seen;
    if (distance(seen.position_in_map, pedestrian.position_in_map) < kLegsReachM) last = std::max(last, seen.last_seen);
  }
  return std::min(last, now);  // a clock may be set back
}

/// Since when this place has been known for one that a pedestrian stands at.
Time stands_since(Vec2 place, double radius_m, const StandingPedestrians& before, Time now) {
  Time since = now;
  for (const StandingPedestrian& pedestrian : before) {
    if (distance(pedestrian.position_in_map, place) < radius_m) since = std::min(since, pedestrian.since);
  }
  return since;
}

}  // namespace

void update_standing(const Targets& targets, const EvidenceMap& still, const LineOfSight& sight, Time now,
                     StandingPedestrians& standing) noexcept {
  const StandingPedestrians before = standing;
  standing.clear();
  for (const Target& target : targets) {
    if (!target.existence.maybe_pedestrian || target.estimate.track.moving) continue;
    const Track& seen = target.estimate.as_seen;
    const Time since = stands_since(seen.position_in_map, target.estimate.track.radius_m, before, now);
    (void)standing.push_back(
        {seen.position_in_map, target.estimate.track.radius_m, seen.last_seen, since});  // as many as bodies
  }
  for (StandingPedestrian pedestrian : before) {
    pedestrian.last_seen = last_seen(pedestrian, targets, now);
    const bool stays = something_stands(pedestrian, still) || may_be_hidden(pedestrian, sight, now);
    if (stays && !is_tracked(pedestrian, targets) && !standing.push_back(pedestrian)) return;
  }
}

}  // namespace jaywalk
