#include <algorithm>
#include <limits>

#include "hal/types/trig.h"
#include "planner/tracking/imm_filter.h"
#include "planner/tracking/target.h"
#include "planner/tracking/tuning.h"

namespace jaywalk {
namespace {
constexpr double kGate2 = 11.8;     // chi-squared, two degrees of freedom, 99.7 %
constexpr double kBelongsM = 0.45;  // a detection this near a target is part of it
constexpr double kGateStdM = 0.18;  // whatever part of a target is seen: a gate of 0.62 m, a stride, at the least
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The leg nearest to leg `lead` among those given to track `owner`; -1: none within a stride.
std::int32_t fellow_leg(const Detections& detections, std::size_t lead, std::uint32_t owner) {
  std::int32_t best = -1;
  double best_distance = kStrideM;
  for (std::size_t k = 0; k < detections.size(); ++k) {
    const Detection& c = detections[k];
    if (k == lead || c.track_id != owner || !c.leg()) continue;
    const double d = distance(c.centre_in_map, detections[lead].centre_in_map);
    if (d < best_distance) best_distance = d, best = static_cast<std::int32_t>(k);
  }
  return best;
}

/// Price of a wide covariance: a target that was seen once and may be anywhere by now has everything near it, and would
/// take others' legs. Half of what the logarithm of a Gaussian has: with all of it people that sway lose theirs to
/// things that stand (recall of walkers 91.0, not 92.1 %).
double log_determinant_term(const Track& track) { return log(track.covariance.pp + kGateStdM * kGateStdM); }

void free_strangers(const Track& track, std::size_t lead, std::int32_t fellow, Detections& detections) {
  for (std::size_t k = 0; k < detections.size(); ++k) {
    Detection& c = detections[k];
    const bool used = k == lead || static_cast<std::int32_t>(k) == fellow;
    if (c.track_id == track.id && !used && distance(c.centre_in_map, track.position_in_map) > kBelongsM) c.track_id = 0;
  }
}

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

void associate(const Targets& targets, Detections& detections) noexcept {
  for (Detection& c : detections) {
    double best = kInfinity;
    for (const Target& target : targets) {
      const double d2 =
          gate_distance2(target.estimate.track, c.centre_in_map, kGateStdM, target.estimate.late_by(c.late_s));
      if (target.existence.given || d2 >= kGate2) continue;
      const double unlikely = d2 + log_determinant_term(target.estimate.track);
      if (unlikely < best) best = unlikely, c.track_id = target.estimate.track.id;
    }
  }
}

bool observe(const Track& track, const Appearance& known, Detections& detections, Observation& out) noexcept {
  std::size_t lead = detections.size();
  double nearest = kInfinity;
  for (std::size_t k = 0; k < detections.size(); ++k) {
    const double d = distance(detections[k].centre_in_map, track.position_in_map);
    if (detections[k].track_id == track.id && d < nearest) nearest = d, lead = k;
  }
  if (lead == detections.size()) return false;
  const std::int32_t fellow = detections[lead].leg() ? fellow_leg(detections, lead, track.id) : -1;
  out = observation_of(detections, lead, fellow, known.arc_m, known.on_legs());
  if (out.arc_m > 0.0 && known.arc_m == 0.0) out.was_off = off_by_one_side(detections[lead], known.hidden_side);
  free_strangers(track, lead, fellow, detections);
  return true;
}

bool observe_new(Detections& detections, std::size_t index, std::uint32_t becomes_track_id, Observation& out) noexcept {
  const std::int32_t fellow = detections[index].leg() ? fellow_leg(detections, index, 0) : -1;
  if (detections[index].sparse && fellow < 0) return false;
  out = observation_of(detections, index, fellow, 0.0, false);
  detections[index].track_id = becomes_track_id;
  if (fellow >= 0) detections[static_cast<std::size_t>(fellow)].track_id = becomes_track_id;
  return true;
}

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
