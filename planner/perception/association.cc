#include "planner/perception/association.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hal/types/trig.h"
#include "planner/perception/kalman.h"

namespace jaywalk {
namespace {

constexpr double kGate2 = 11.8;          // chi-squared, two degrees of freedom, 99.7 %
constexpr double kStrideM = 0.6;         // between a person's legs in mid-step
constexpr double kBelongsM = 0.45;       // a cluster this near a body is part of it
constexpr double kPersonRadiusM = 0.25;  // of whoever was not seen whole yet
constexpr double kLeastRadiusM = 0.2;    // whatever stands on legs is wider than they are
constexpr double kMostRadiusM = 0.5;

// Standard deviations of where the body's centre is, an axis. One leg lies up to a quarter of a stride off the middle,
// and does so for several scans, for which it counts double; so far apart both kinds have innovations of 2 of real
// people (docs/tracking-findings.md, "People have legs"). An arc's ends lie somewhere between beams; an arc's are what
// simulated discs turned out to have.
constexpr double kOneLegStdM = 0.25, kTwoLegsStdM = 0.07;
constexpr double kDeeperM = 0.08;  // than a leg that hides the other one: half of what is from one to the other
constexpr double kArcStdM = 0.0035, kArcStdPerSpacing = 0.17;
// Of what is hidden of a body whose width is known: with it innovations are 2 on average, all bodies together
// (docs/tracking-findings.md, "What is hidden of a body").
constexpr double kHiddenStdPerM = 0.05;
constexpr double kLeastShare = 1e-3;   // of a body's width that is seen: beams may be all one
constexpr double kGateStdM = 0.12;     // whatever part of a body is seen
constexpr double kWidthOfBoth = 0.75;  // of two bodies' widths: one alone is not as wide

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool width_known(const Body& body) { return !body.given && body.confirmed() && body.arc_m > 0.0; }

/// No two known bodies together are narrower, m: whatever is, need not be looked at.
double least_width_of_both(const Bodies& bodies) {
  double least_arc_m = kInfinity;
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
  return k;
}

/// The leg nearest to leg `lead` among those given to track `owner`; -1: none within a stride.
std::int32_t fellow_leg(const Clusters& clusters, std::size_t lead, std::uint32_t owner) {
  std::int32_t best = -1;
  double best_distance = kStrideM;
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    const Cluster& c = clusters[k];
    if (k == lead || c.track_id != owner || !c.leg()) continue;
    const double d = distance(c.centre_in_map, clusters[lead].centre_in_map);
    if (d < best_distance) best_distance = d, best = static_cast<std::int32_t>(k);
  }
  return best;
}

/// Of a half circle of radius 1 that is seen from one side up to `share` of its width: how far its mean lies before
/// its centre. With the angle a that is seen, (a - sin a cos a) / (2 (1 - cos a)); all of it, kArcMean.
double arc_mean(double share) {
  share = std::clamp(share, kLeastShare, 1.0);
  const double c = 1.0 - 2.0 * share, s = std::sqrt(std::max(0.0, 1.0 - c * c));
  return (atan2(s, c) - s * c) / (4.0 * share);
}

/// Moves what was taken for the middle of the cluster to the middle of its body, which is `arc_m` from the side that is
/// seen, and no farther, were more of it in view: what comes into view of who stands must not move him. Hidden on both
/// sides, it may be either way.
void be_told_by_a_side(const Cluster& c, double arc_m, Observation& seen) {
  const double hidden = arc_m - c.radius_m;
  seen.std_m += (c.hidden_side() == 0 ? 1.0 : kHiddenStdPerM) * std::max(0.0, hidden);
  if (c.hidden_side() == 0) return;
  const double deeper = arc_m * arc_mean(c.radius_m / arc_m) - c.radius_m * kArcMean;
  seen.position_in_map = seen.position_in_map + c.high_side * (c.hidden_side() * hidden) + c.along * deeper;
  if (hidden < 0.0) seen.radius_m = std::min(seen.radius_m - hidden, kMostRadiusM);  // what is seen reaches so far
}

/// From where one side of `c` had its middle while its width was not known, to where both have it.
Vec2 off_by_one_side(const Cluster& c, int hidden_side) {
  if (hidden_side == 0) return {};
  return (c.high_side * hidden_side + c.along * kArcMean) * (c.radius_m - kPersonRadiusM);
}

void be_legs(const Clusters& clusters, std::size_t lead, std::int32_t fellow, Observation& seen) {
  const Cluster& c = clusters[lead];
  const bool alone = fellow < 0 && c.one_leg();
  seen.std_m = alone ? kOneLegStdM : kTwoLegsStdM;
  seen.radius_m = kPersonRadiusM;
  if (fellow >= 0) {
    seen.position_in_map = (c.centre_in_map + clusters[static_cast<std::size_t>(fellow)].centre_in_map) * 0.5;
  } else if (alone && c.whole()) {
    seen.position_in_map = c.centre_in_map + c.along * kDeeperM;
  }
}

/// `arc_m`: Body::arc_m.
Observation observation_of(const Clusters& clusters, std::size_t lead, std::int32_t fellow, double arc_m) {
  const Cluster& c = clusters[lead];
  Observation seen{.position_in_map = c.centre_in_map,
                   .std_m = kArcStdM + kArcStdPerSpacing * c.spacing_m,
                   .radius_m = std::clamp(c.radius_m, kLeastRadiusM, kMostRadiusM),
                   .in_free_space = c.in_free_space,
                   .outline_in_map = c.outline_in_map,
                   .beams = c.beams,
                   .whole = c.whole(),
                   .hidden_side = c.hidden_side(),
                   .on_wall = c.on_wall,
                   .edge_m = c.emerges() ? c.spacing_m : 0.0,
                   .width_m = distance(c.outline_in_map[0], c.outline_in_map.back()),
                   .spacing_m = c.spacing_m,
                   .was_off = {}};
  if (seen.whole) {
    if (!c.leg()) seen.arc_m = c.radius_m;
  } else {
    be_told_by_a_side(c, arc_m > 0.0 ? std::max(arc_m, c.radius_m) : kPersonRadiusM, seen);
  }
  const bool part_of_more = !seen.whole && arc_m > 0.0;
  if (c.leg() && !part_of_more && !c.behind_more) be_legs(clusters, lead, fellow, seen);
  return seen;
}

/// For being unsure of one's place: who was seen once and may be anywhere by now has everything near him, and would
/// take others' legs. Half of what the logarithm of a Gaussian has: with all of it people who sway lose theirs to
/// things that stand (docs/tracking-findings.md, "Dark cloth").
double price_of_doubt(const Track& track) { return log(track.covariance.pp + kGateStdM * kGateStdM); }

void free_strangers(const Track& track, std::size_t lead, std::int32_t fellow, Clusters& clusters) {
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    Cluster& c = clusters[k];
    const bool used = k == lead || static_cast<std::int32_t>(k) == fellow;
    if (c.track_id == track.id && !used && distance(c.centre_in_map, track.position_in_map) > kBelongsM) c.track_id = 0;
  }
}

}  // namespace

void cut_between(const Bodies& bodies, const PointsInMap& in_map, Segments& segments) noexcept {
  const double least_m = least_width_of_both(bodies);
  const Segments before = segments;
  segments.clear();
  for (Segment rest : before) {
    std::uint32_t next = second_body(bodies, in_map, rest, least_m);
    while (next != rest.first) {
      if (!segments.push_back({rest.first, next - 1})) return;
      rest.first = next;
      next = second_body(bodies, in_map, rest, least_m);
    }
    if (!segments.push_back(rest)) return;
  }
}

void associate(const Bodies& bodies, Clusters& clusters) noexcept {
  for (Cluster& c : clusters) {
    double best = kInfinity;
    for (const Body& body : bodies) {
      const double d2 = gate_distance2(body.track, c.centre_in_map, kGateStdM);
      if (body.given || d2 >= kGate2) continue;
      const double unlikely = d2 + price_of_doubt(body.track);
      if (unlikely < best) best = unlikely, c.track_id = body.track.id;
    }
  }
}

bool observe(const Body& body, Clusters& clusters, Observation& out) noexcept {
  const Track& track = body.track;
  std::size_t lead = clusters.size();
  double nearest = kInfinity;
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    const double d = distance(clusters[k].centre_in_map, track.position_in_map);
    if (clusters[k].track_id == track.id && d < nearest) nearest = d, lead = k;
  }
  if (lead == clusters.size()) return false;
  const std::int32_t fellow = clusters[lead].leg() ? fellow_leg(clusters, lead, track.id) : -1;
  out = observation_of(clusters, lead, fellow, body.arc_m);
  if (out.arc_m > 0.0 && body.arc_m == 0.0) out.was_off = off_by_one_side(clusters[lead], body.hidden_side);
  free_strangers(track, lead, fellow, clusters);
  return true;
}

bool observe_new(Clusters& clusters, std::size_t index, std::uint32_t becomes_track_id, Observation& out) noexcept {
  const std::int32_t fellow = clusters[index].leg() ? fellow_leg(clusters, index, 0) : -1;
  if (clusters[index].sparse && fellow < 0) return false;
  out = observation_of(clusters, index, fellow, 0.0);
  clusters[index].track_id = becomes_track_id;
  if (fellow >= 0) clusters[static_cast<std::size_t>(fellow)].track_id = becomes_track_id;
  return true;
}

}  // namespace jaywalk
