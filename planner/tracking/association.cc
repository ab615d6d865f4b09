#include "planner/tracking/association.h"

#include <limits>

#include "hal/types/trig.h"
#include "planner/tracking/kalman.h"

namespace jaywalk {
namespace {

constexpr double kGate2 = 11.8;     // chi-squared, two degrees of freedom, 99.7 %
constexpr double kBelongsM = 0.45;  // a cluster this near a body is part of it
constexpr double kGateStdM = 0.18;  // whatever part of a body is seen: a gate of 0.62 m, a stride, at the least
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

/// For being unsure of one's place: who was seen once and may be anywhere by now has everything near him, and would
/// take others' legs. Half of what the logarithm of a Gaussian has: with all of it people who sway lose theirs to
/// things that stand (recall of walkers 91.0, not 92.1 %).
double price_of_doubt(const Track& track) { return log(track.covariance.pp + kGateStdM * kGateStdM); }

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
    double best = kInfinity;
    for (const Body& body : bodies) {
      const double d2 = gate_distance2(body.track, c.centre_in_map, kGateStdM, body.late_by(c.late_s));
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
  out = observation_of(clusters, lead, fellow, body.arc_m, body.on_legs());
  if (out.arc_m > 0.0 && body.arc_m == 0.0) out.was_off = off_by_one_side(clusters[lead], body.hidden_side);
  free_strangers(track, lead, fellow, clusters);
  return true;
}

bool observe_new(Clusters& clusters, std::size_t index, std::uint32_t becomes_track_id, Observation& out) noexcept {
  const std::int32_t fellow = clusters[index].leg() ? fellow_leg(clusters, index, 0) : -1;
  if (clusters[index].sparse && fellow < 0) return false;
  out = observation_of(clusters, index, fellow, 0.0, false);
  clusters[index].track_id = becomes_track_id;
  if (fellow >= 0) clusters[static_cast<std::size_t>(fellow)].track_id = becomes_track_id;
  return true;
}

}  // namespace jaywalk
