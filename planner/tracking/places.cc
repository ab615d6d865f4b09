#include "planner/tracking/places.h"

#include <algorithm>

namespace jaywalk {
namespace {

bool covers(const Outline& outline, Vec2 place, double within) {
  return std::any_of(outline.begin(), outline.end(), [&](Vec2 p) { return distance(p, place) < within; });
}

}  // namespace

OldPlace old_place(const Body& body, const Surroundings& around) noexcept {
  OldPlace old;
  const double tolerance = wall_noise_m(distance(around.laser_in_map(), body.track.position_in_map));
  const Vec2 way = body.track.position_in_map - body.anchor_in_map;
  const Outline& outline = body.anchor_outline;  // in the order of the beams, so that it has two ends
  if (outline.empty()) return old;
  const bool first_lags = dot(outline.back() - outline[0], way) > 0.0;
  for (std::size_t k = 0; k < (outline.size() + 1) / 2; ++k) {
    const Vec2 place = outline[first_lags ? k : outline.size() - 1 - k];
    if (covers(body.outline_in_map, place, tolerance)) continue;
    const Sight seen = around.sight.at(place, tolerance, body.beams);
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
