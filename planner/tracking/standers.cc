#include "planner/tracking/standers.h"

#include <algorithm>

#include "planner/tracking/hidden_walkers.h"

namespace jaywalk {
namespace {

/// Whether he is one of the bodies, standing or about to go on.
bool is_followed(const Stander& stander, const Bodies& bodies) {
  return std::any_of(bodies.begin(), bodies.end(), [&](const Body& body) {
    return body.somebody && distance(body.as_seen.position_in_map, stander.position_in_map) < stander.radius_m;
  });
}

bool something_stands(const Stander& stander, const EvidenceMap& still) {
  const Vec2 reach{kLegsReachM, kLegsReachM};
  const CellIndex low = still.cell_at(stander.position_in_map - reach);
  const CellIndex high = still.cell_at(stander.position_in_map + reach);
  for (std::int32_t j = low.j; j <= high.j; ++j) {
    for (std::int32_t i = low.i; i <= high.i; ++i) {
      if (!still.occupied({i, j})) continue;
      if (distance(still.surface({i, j}), stander.position_in_map) < kLegsReachM) return true;
    }
  }
  return false;
}

/// No beam passes over his place, and it is not long since he was seen there.
bool may_be_hidden(const Stander& stander, const LineOfSight& sight, Time now) {
  const double unseen_s = to_seconds(now - stander.last_seen);
  return unseen_s < kRememberedS && sight.at(stander.position_in_map, kLegsReachM) != Sight::kThrough;
}

/// When something was seen last where he stands: who comes into view again is born anew, and may show a leg alone.
Time last_seen(const Stander& stander, const Bodies& bodies, Time now) {
  Time last = stander.last_seen;
  for (const Body& body : bodies) {
    const Track& seen = body.as_seen;
    if (distance(seen.position_in_map, stander.position_in_map) < kLegsReachM) last = std::max(last, seen.last_seen);
  }
  return std::min(last, now);  // a clock may be set back
}

/// Since when this place has been known for one that a pedestrian stands at.
Time stands_since(Vec2 place, double radius_m, const Standers& before, Time now) {
  Time since = now;
  for (const Stander& stander : before) {
    if (distance(stander.position_in_map, place) < radius_m) since = std::min(since, stander.since);
  }
  return since;
}

}  // namespace

void note_standers(const Bodies& bodies, const EvidenceMap& still, const LineOfSight& sight, Time now,
                   Standers& standers) noexcept {
  const Standers before = standers;
  standers.clear();
  for (const Body& body : bodies) {
    if (!body.somebody || body.track.moving) continue;
    const Track& seen = body.as_seen;
    const Time since = stands_since(seen.position_in_map, body.track.radius_m, before, now);
    (void)standers.push_back({seen.position_in_map, body.track.radius_m, seen.last_seen, since});  // as many as bodies
  }
  for (Stander stander : before) {
    stander.last_seen = last_seen(stander, bodies, now);
    const bool stays = something_stands(stander, still) || may_be_hidden(stander, sight, now);
    if (stays && !is_followed(stander, bodies) && !standers.push_back(stander)) return;
  }
}

}  // namespace jaywalk
