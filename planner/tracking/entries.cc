#include "planner/tracking/entries.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace jaywalk {
namespace {

Becomes entry_of(const Bodies& bodies, const Cluster& cluster, Time now) {
  const auto body =
      std::find_if(bodies.begin(), bodies.end(), [&](const Body& b) { return b.track.id == cluster.track_id; });
  if (body == bodies.end()) return Becomes::kWall;
  if (body->track.moving || (cluster.in_free_space && body->confirmed() && !body->settled)) return Becomes::kNothing;
  const bool may_walk_on = !cluster.on_wall && body->whole && body->solid() && now - body->born < kMayGoOnWithin;
  return may_walk_on ? Becomes::kObstacle : Becomes::kWall;
}

/// Nor do points near one who moves, where nothing stands: not all of a swinging leg's are the cluster's.
void leave_out_movers(const Bodies& bodies, const PointsInMap& in_map, std::size_t count, const EvidenceMap& still,
                      Entries& out) {
  for (const Body& body : bodies) {
    if (!body.track.moving) continue;
    const Vec2 middle = body.track.position_in_map;
    const double reach = body.track.radius_m + kSkinM;
    for (std::size_t k = 0; k < count; ++k) {
      const Vec2 p = in_map.position[k];
      if (!(std::fabs(p.x - middle.x) < reach && distance(p, middle) < reach)) continue;  // most end at the first
      if (!still.occupied(still.cell_at(p))) out[k] = Becomes::kNothing;
    }
  }
}

}  // namespace

void decide_entries(const Bodies& bodies, const Clusters& clusters, const PointsInMap& in_map, std::size_t count,
                    const EvidenceMap& still, Time now, Entries& out) noexcept {
  std::fill(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(count), Becomes::kWall);
  for (const Cluster& c : clusters) {
    const Becomes entry = entry_of(bodies, c, now);
    for (std::uint32_t k = c.segment.first; k <= c.segment.last; ++k) out[k] = entry;
  }
  leave_out_movers(bodies, in_map, count, still, out);
}

}  // namespace jaywalk
