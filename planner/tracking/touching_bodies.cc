#include "planner/tracking/touching_bodies.h"

#include <algorithm>
#include <limits>

namespace jaywalk {
namespace {

constexpr double kWidthOfBoth = 0.75;  // of two bodies' widths: one alone is not as wide

bool width_known(const Body& body) { return !body.given && body.confirmed() && body.arc_m > 0.0; }

/// No two known bodies together are narrower, m: whatever is, need not be looked at.
double least_width_of_both(const Bodies& bodies) {
  double least_arc_m = std::numeric_limits<double>::infinity();
  for (const Body& body : bodies) {
    if (width_known(body)) least_arc_m = std::min(least_arc_m, body.arc_m);
  }
  return kWidthOfBoth * 4.0 * least_arc_m;
}

/// The body of known width that a point lies on, or nearest to; null: none.
const Body* body_under(const Bodies& bodies, Vec2 p_in_map) {
  const Body* best = nullptr;
  double nearest = kSkinM;
  for (const Body& body : bodies) {
    if (!width_known(body)) continue;
    const double off = distance(body.track.position_in_map, p_in_map) - body.arc_m;
    if (off < nearest) nearest = off, best = &body;
  }
  return best;
}

/// The first point of the segment's second body; its first point: it is not two, as nothing under `least_m` is.
std::uint32_t second_body(const Bodies& bodies, const PointsInMap& in_map, const Segment& s, double least_m) {
  const double width_m = distance(in_map.position[s.first], in_map.position[s.last]);
  if (width_m < least_m) return s.first;
  const Body* const one = body_under(bodies, in_map.position[s.first]);
  const Body* const other = body_under(bodies, in_map.position[s.last]);
  if (one == nullptr || other == nullptr || one == other) return s.first;
  if (!one->track.moving && !other->track.moving) return s.first;
  if (width_m < kWidthOfBoth * 2.0 * (one->arc_m + other->arc_m)) return s.first;
  std::uint32_t k = s.first;
  while (body_under(bodies, in_map.position[k]) == one) ++k;  // its last point is the other's
  std::uint32_t others = k;
  while (body_under(bodies, in_map.position[others]) == nullptr) ++others;
  return k + (others - k) / 2;  // half of what is nobody's
}

}  // namespace

void cut_between(const Bodies& bodies, const PointsInMap& in_map, Segments& segments) noexcept {
  const double least_m = least_width_of_both(bodies);
  const Segments before = segments;
  segments.clear();
  for (Segment rest : before) {
    std::uint32_t next = second_body(bodies, in_map, rest, least_m);
    while (next != rest.first) {
      (void)segments.push_back({rest.first, next - 1});  // never full: a point each
      rest.first = next;
      next = second_body(bodies, in_map, rest, least_m);
    }
    (void)segments.push_back(rest);
  }
}

}  // namespace jaywalk
