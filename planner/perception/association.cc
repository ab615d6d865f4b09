#include "planner/perception/association.h"

#include <algorithm>
#include <limits>

#include "planner/perception/kalman.h"

namespace jaywalk {
namespace {

constexpr double kGate2 = 11.8;     // chi-squared, two degrees of freedom, 99.7 %
constexpr double kStrideM = 0.6;    // between a person's legs in mid-step
constexpr double kBelongsM = 0.45;  // a cluster this near a body is part of it
constexpr double kPersonRadiusM = 0.25;
constexpr double kLeastRadiusM = 0.2;  // whatever stands on legs is wider than they are
constexpr double kMostRadiusM = 0.5;

// Standard deviations of where the body's centre is, an axis. One leg lies up to a quarter of a stride off the middle.
constexpr double kOneLegStdM = 0.12;
constexpr double kTwoLegsStdM = 0.08;
constexpr double kArcStdM = 0.05;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

Observation observation_of(const Clusters& clusters, std::size_t lead, std::int32_t fellow) {
  const Cluster& c = clusters[lead];
  Observation seen{c.centre_in_map, kArcStdM, std::clamp(c.radius_m, kLeastRadiusM, kMostRadiusM), c.in_free_space,
                   c.outline_in_map};
  if (!c.leg()) return seen;
  seen.std_m = kOneLegStdM;
  seen.radius_m = kPersonRadiusM;
  if (fellow < 0) return seen;
  seen.std_m = kTwoLegsStdM;
  seen.position_in_map = (c.centre_in_map + clusters[static_cast<std::size_t>(fellow)].centre_in_map) * 0.5;
  return seen;
}

void free_strangers(const Track& track, std::size_t lead, std::int32_t fellow, Clusters& clusters) {
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    Cluster& c = clusters[k];
    const bool used = k == lead || static_cast<std::int32_t>(k) == fellow;
    if (c.track_id == track.id && !used && distance(c.centre_in_map, track.position_in_map) > kBelongsM) c.track_id = 0;
  }
}

}  // namespace

void associate(const Bodies& bodies, Clusters& clusters) noexcept {
  for (Cluster& c : clusters) {
    double best = kGate2;
    for (const Body& body : bodies) {
      if (body.given) continue;
      const double d2 = gate_distance2(body.track, c.centre_in_map, c.leg() ? kOneLegStdM : kArcStdM);
      if (d2 < best) best = d2, c.track_id = body.track.id;
    }
  }
}

bool observe(const Track& track, Clusters& clusters, Observation& out) noexcept {
  std::size_t lead = clusters.size();
  double nearest = kInfinity;
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    const double d = distance(clusters[k].centre_in_map, track.position_in_map);
    if (clusters[k].track_id == track.id && d < nearest) nearest = d, lead = k;
  }
  if (lead == clusters.size()) return false;
  const std::int32_t fellow = clusters[lead].leg() ? fellow_leg(clusters, lead, track.id) : -1;
  out = observation_of(clusters, lead, fellow);
  free_strangers(track, lead, fellow, clusters);
  return true;
}

Observation observe_new(Clusters& clusters, std::size_t index, std::uint32_t becomes_track_id) noexcept {
  const std::int32_t fellow = clusters[index].leg() ? fellow_leg(clusters, index, 0) : -1;
  const Observation seen = observation_of(clusters, index, fellow);
  clusters[index].track_id = becomes_track_id;
  if (fellow >= 0) clusters[static_cast<std::size_t>(fellow)].track_id = becomes_track_id;
  return seen;
}

}  // namespace jaywalk
