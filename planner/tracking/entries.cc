#include "planner/tracking/entries.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "planner/tracking/tuning.h"

namespace jaywalk {
namespace {

Becomes entry_of(const Targets& targets, const Detection& detection, Time now) {
  const auto target = std::find_if(targets.begin(), targets.end(),
                                   [&](const Target& b) { return b.estimate.track.id == detection.track_id; });
  if (target == targets.end()) return Becomes::kWall;
  if (target->estimate.track.moving || (detection.in_free_space && target->confirmed() && !target->existence.settled))
    return Becomes::kNothing;
  const bool may_walk_on = !detection.on_wall && target->appearance.whole && target->appearance.solid() &&
                           now - target->existence.born < kMayGoOnWithin;
  return may_walk_on ? Becomes::kObstacle : Becomes::kWall;
}

/// Nor do points near a moving target, where nothing stands: not all of a swinging leg's are the detection's.
void leave_out_movers(const Targets& targets, std::span<const Vec2> points_in_map, const EvidenceMap& still,
                      Entries& out) {
  for (const Target& target : targets) {
    if (!target.estimate.track.moving) continue;
    const Vec2 middle = target.estimate.track.position_in_map;
    const double reach = target.estimate.track.radius_m + kSkinM;
    for (std::size_t k = 0; k < points_in_map.size(); ++k) {
      const Vec2 p = points_in_map[k];
      if (!(std::fabs(p.x - middle.x) < reach && distance(p, middle) < reach)) continue;  // most end at the first
      if (!still.occupied(still.cell_at(p))) out[k] = Becomes::kNothing;
    }
  }
}

}  // namespace

void decide_entries(const Targets& targets, const Detections& detections, std::span<const Vec2> points_in_map,
                    const EvidenceMap& still, Time now, Entries& out) noexcept {
  std::fill_n(out.begin(), points_in_map.size(), Becomes::kWall);
  for (const Detection& c : detections) {
    const Becomes entry = entry_of(targets, c, now);
    for (std::uint32_t k = c.segment.first; k <= c.segment.last; ++k) out[k] = entry;
  }
  leave_out_movers(targets, points_in_map, still, out);
}

}  // namespace jaywalk
