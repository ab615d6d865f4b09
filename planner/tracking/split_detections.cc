#include "planner/tracking/split_detections.h"

#include <algorithm>
#include <limits>

#include "planner/tracking/tuning.h"

namespace jaywalk {
namespace {

constexpr double kWidthOfBoth = 0.75;  // of two bodies' widths: one alone is not as wide

bool width_known(const Target& target) {
  return !target.existence.given && target.confirmed() && target.appearance.arc_m > 0.0;
}

/// No two known bodies together are narrower, m: whatever is, need not be looked at.
double least_width_of_both(const Targets& targets) {
  double least_arc_m = std::numeric_limits<double>::infinity();
  for (const Target& target : targets) {
    if (width_known(target)) least_arc_m = std::min(least_arc_m, target.appearance.arc_m);
  }
  return kWidthOfBoth * 4.0 * least_arc_m;
}

/// The body of known width that a point lies on, or nearest to; null: none.
const Target* target_under(const Targets& targets, Vec2 p_in_map) {
  const Target* best = nullptr;
  double nearest = kSkinM;
  for (const Target& target : targets) {
    if (!width_known(target)) continue;
    const double off = distance(target.estimate.track.position_in_map, p_in_map) - target.appearance.arc_m;
    if (off < nearest) nearest = off, best = &target;
  }
  return best;
}

/// The first point of the segment's second body; its first point: it is not two, as nothing under `least_m` is.
std::uint32_t second_target(const Targets& targets, const PointsInMap& in_map, const Segment& s, double least_m) {
  const double width_m = distance(in_map.position[s.first], in_map.position[s.last]);
  if (width_m < least_m) return s.first;
  const Target* const one = target_under(targets, in_map.position[s.first]);
  const Target* const other = target_under(targets, in_map.position[s.last]);
  if (one == nullptr || other == nullptr || one == other) return s.first;
  if (!one->estimate.track.moving && !other->estimate.track.moving) return s.first;
  if (width_m < kWidthOfBoth * 2.0 * (one->appearance.arc_m + other->appearance.arc_m)) return s.first;
  std::uint32_t k = s.first;
  while (target_under(targets, in_map.position[k]) == one) ++k;  // its last point is the other's
  std::uint32_t others = k;
  while (target_under(targets, in_map.position[others]) == nullptr) ++others;
  return k + (others - k) / 2;  // half of what is nobody's
}

}  // namespace

void split_detections(const Targets& targets, const PointsInMap& in_map, Segments& segments) noexcept {
  const double least_m = least_width_of_both(targets);
  const Segments before = segments;
  segments.clear();
  for (Segment rest : before) {
    std::uint32_t next = second_target(targets, in_map, rest, least_m);
    while (next != rest.first) {
      (void)segments.push_back({rest.first, next - 1});  // never full: a point each
      rest.first = next;
      next = second_target(targets, in_map, rest, least_m);
    }
    (void)segments.push_back(rest);
  }
}

}  // namespace jaywalk
