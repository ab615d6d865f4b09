#include "planner/perception/places.h"

#include <algorithm>

namespace jaywalk {
namespace {

constexpr double kSameM = 0.08, kSamePerM = 0.015;  // about a point of the anchor, what ends there is still it
constexpr double kBesideM = 0.05, kPrintM = 0.02;   // surfaces in cells are known so well
constexpr double kOnFreeGround = 0.7;               // chosen: without it 7 of 125 starts set something off, not 4

bool covers(const Outline& outline, Vec2 place, double within) {
  return std::any_of(outline.begin(), outline.end(), [&](Vec2 p) { return distance(p, place) < within; });
}

/// Whether what returns at a place of its old outline may be what has long stood beside it: sparse beams ask so far
/// about a place that furniture answers for it. Who is seen whole on free ground alone is believed so: others are
/// furniture.
bool stood_beside(const Body& body, const EvidenceMap& still, Vec2 place, double tolerance) {
  if (!body.whole || body.arc_m <= 0.0 || body.free_share < kOnFreeGround) return false;
  const double reach_m = tolerance + kBesideM;
  const CellIndex low = still.cell_at(place - Vec2{reach_m, reach_m}),
                  high = still.cell_at(place + Vec2{reach_m, reach_m});
  for (std::int32_t j = low.j; j <= high.j; ++j) {
    for (std::int32_t i = low.i; i <= high.i; ++i) {
      if (!still.stands({i, j})) continue;
      const Vec2 surface = still.surface({i, j});  // his own print lies within his width
      if (distance(surface, place) < reach_m && distance(surface, body.anchor_in_map) > body.arc_m + kPrintM)
        return true;
    }
  }
  return false;
}

}  // namespace

OldPlace old_place(const Body& body, const Surroundings& around) noexcept {
  OldPlace old;
  const double tolerance = kSameM + kSamePerM * distance(around.laser_in_map(), body.track.position_in_map);
  const Vec2 way = body.track.position_in_map - body.anchor_in_map;
  const Outline& outline = body.anchor_outline;  // in the order of the beams, so that it has two ends
  if (outline.empty()) return old;
  const bool first_lags = dot(outline.back() - outline[0], way) > 0.0;
  for (std::size_t k = 0; k < (outline.size() + 1) / 2; ++k) {
    const Vec2 place = outline[first_lags ? k : outline.size() - 1 - k];
    if (covers(body.outline_in_map, place, tolerance)) continue;
    const Sight seen = around.sight.at(place, tolerance, body.beams);
    if (seen == Sight::kThere && stood_beside(body, around.still, place, tolerance)) continue;
    old.taken = old.taken || seen == Sight::kThere;
    old.through = old.through || seen == Sight::kThrough || seen == Sight::kEmpty;
  }
  return old;
}

bool enters_free_ground(const Body& body, const EvidenceMap& still) noexcept {
  const Outline& outline = body.outline_in_map;
  if (outline.empty()) return false;
  Vec2 sum;
  for (const Vec2& p : outline) sum = sum + p;
  const Vec2 middle = sum * (1.0 / static_cast<double>(outline.size()));
  return std::any_of(outline.begin(), outline.end(), [&](Vec2 p) {
    return dot(p - middle, body.track.velocity_in_map) > 0.0 && still.seen_free(still.cell_at(p));
  });
}

}  // namespace jaywalk
