#include "planner/tracking/sighting.h"

#include <algorithm>
#include <cmath>

#include "planner/tracking/kalman.h"

namespace jaywalk {
namespace {

constexpr double kFreeGain = 0.3;       // of the running mean of how free the ground under a body was
constexpr double kNoiseGain = 0.075;    // a scan: a second teaches how noisy a body is
constexpr double kMostNoise = 25.0;     // times the variance expected, or as small a part of it
constexpr double kMostSurprise = 16.0;  // that one scan teaches: more is another's place

/// Steers the measurement noise to where surprises are 2 on average, whatever the body is: a disc is seen to a
/// centimetre, a pair of legs sways.
void learn_noise(Body& body) {
  const double wanted = 0.5 * std::min(body.track.surprise, kMostSurprise) - 1.0;
  body.noise = std::clamp(body.noise * (1.0 + kNoiseGain * wanted), 1.0 / kMostNoise, kMostNoise);
}

void learn_size(Body& body, const Observation& seen) {
  body.track.radius_m += kMeanGain * (seen.radius_m - body.track.radius_m);
  body.legs_share += kMeanGain * ((seen.two_legs ? 1.0 : 0.0) - body.legs_share);
  if (body.on_legs()) body.arc_m = 0.0;
  if (seen.arc_m > 0.0) body.arc_m += (body.arc_m > 0.0 ? kMeanGain : 1.0) * (seen.arc_m - body.arc_m);
}

/// Where both legs are seen their middle may be known to a centimetre. That says nothing of one leg alone: for a step
/// it stands on the ground, and whoever believed it so well would have him stand.
double noise_of(const Body& body, const Observation& seen) {
  return seen.lone_leg ? std::max(body.noise, 1.0) : body.noise;
}

void correct_track(Body& body, const Observation& seen) {
  move_all(body, seen.was_off);
  const double late_s = body.late_by(seen.late_s);
  const double smeared_m = norm(body.track.velocity_in_map) * body.late_by(seen.late_std_s);
  const double std_m = seen.std_m * std::sqrt(noise_of(body, seen)) + smeared_m;
  body.track.surprise = gate_distance2(body.track, seen.position_in_map, std_m, late_s);
  learn_noise(body);
  body.models.correct(body.track, seen.position_in_map, std_m, late_s);
}

}  // namespace

void note_sight(Body& body, const Observation& seen) noexcept {
  body.outline_in_map = seen.outline_in_map;
  body.beams = seen.beams;
  body.off_std_m = seen.off_std_m;
  body.late_s = seen.late_s;
  body.whole = seen.whole;
  body.hidden_side = seen.hidden_side;
  body.on_wall = seen.on_wall;
  body.edge_m = seen.edge_m;
}

void take_sight(Body& body, const Observation& seen, const Pose2& map_from_laser, Time now) noexcept {
  Track& track = body.track;
  correct_track(body, seen);
  learn_size(body, seen);
  track.hits += 1;
  body.misses = 0;
  const bool after_a_gap = to_seconds(now - track.last_seen) > kPauseS;
  if (after_a_gap) body.path.clear();
  track.last_seen = now;
  body.path.add(now, {seen.position_in_map, seen.width_m, seen.spacing_m, seen.whole});
  note_sight(body, seen);
  if (after_a_gap && !track.moving) anchor_here(body, map_from_laser, now);  // what stood elsewhere may be another
  body.free_share += std::max(kFreeGain, 1.0 / track.hits) * ((seen.in_free_space ? 1.0 : 0.0) - body.free_share);
  body.looked_through_s = 0.0;
  body.as_seen = track;
}

}  // namespace jaywalk
