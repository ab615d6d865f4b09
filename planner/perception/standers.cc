#include "planner/perception/standers.h"

#include <algorithm>

namespace jaywalk {
namespace {

// Of the middle: shins reach 0.16 m (hal/sim/legs.cc), and what he leans on is farther.
constexpr double kLegsWithinM = 0.2;

/// Whether he is one of the bodies, standing or about to go on.
bool is_followed(const Stander& stander, const Bodies& bodies) {
  return std::any_of(bodies.begin(), bodies.end(), [&](const Body& body) {
    return body.somebody && distance(body.as_seen.position_in_map, stander.position_in_map) < stander.radius_m;
  });
}

bool something_stands(const Stander& stander, const EvidenceMap& still) {
  const Vec2 reach{kLegsWithinM, kLegsWithinM};
  const CellIndex low = still.cell_at(stander.position_in_map - reach);
  const CellIndex high = still.cell_at(stander.position_in_map + reach);
  for (std::int32_t j = low.j; j <= high.j; ++j) {
    for (std::int32_t i = low.i; i <= high.i; ++i) {
      if (!still.occupied({i, j})) continue;
      if (distance(still.surface({i, j}), stander.position_in_map) < kLegsWithinM) return true;
    }
  }
  return false;
}

}  // namespace

void note_standers(const Bodies& bodies, const EvidenceMap& still, Standers& standers) noexcept {
  const Standers before = standers;
  standers.clear();
  for (const Body& body : bodies) {
    const bool stands = body.somebody && !body.track.moving;
    if (stands) (void)standers.push_back({body.as_seen.position_in_map, body.track.radius_m});  // as many as bodies
  }
  for (const Stander& stander : before) {
    const bool stays = !is_followed(stander, bodies) && something_stands(stander, still);
    if (stays && !standers.push_back(stander)) return;
  }
}

}  // namespace jaywalk
