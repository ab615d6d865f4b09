#include "planner/tracking/departure.h"

#include <algorithm>
#include <cmath>

#include "planner/tracking/places.h"
#include "planner/tracking/steady_walk.h"

namespace jaywalk {
namespace {

constexpr double kMostlySeen = 0.6;  // of the scans; what flickers is clutter
constexpr double kGoneSigmas = 3.0;
constexpr double kSpeedSigmas = 2.5;
constexpr double kFastMps = 1.8;  // faster than people walk: more often a hop between two like things
constexpr std::size_t kFewestPlaces = 5;
constexpr double kHopM = 0.5 * kStrideM;        // one leg is seen, then the other
constexpr double kExplainedSwaying = 0.6;       // legs take turns in being seen
constexpr double kPerM = 0.1, kCamePerM = 0.2;  // of the walk, a metre of range: 0.1 is 6 degrees of heading
constexpr double kMayStand = 0.5;               // probability that it stands, at most
// Of one who stood: in no_people_left nothing that did came to more than 9.0 by its newest places, at 8.5 nine more of
// 125 starts set something off. Who need not have stood: a thing in Freiburg does. The noise of who sets out came
// to 2.0 in the simulation.
constexpr double kSetsOutSigmas = 10.0, kNoiseSettingOut = 2.5;
constexpr double kChordM = 0.25, kAlong = 0.7;  // legs are narrower; 45 degrees
constexpr double kRound = 0.1;                  // half of what a quarter of a circle has
constexpr double kSlant = 0.35;                 // 20 degrees off square to the beams
constexpr double kRidesWithinM = 1.2;
constexpr double kRidesShare = 0.6;  // of its way in the map is all that it moved before the laser

/// Some of its points, as it was seen last, stand off the line through its ends by kRound of its length.
bool round(const Body& body) {
  const Vec2 first = body.outline_in_map[0], chord = body.outline_in_map.back() - first;
  return std::any_of(body.outline_in_map.begin(), body.outline_in_map.end(),
                     [&](Vec2 p) { return std::fabs(cross(chord, p - first)) > kRound * dot(chord, chord); });
}

/// A piece of wall seen at a slant seems to slide along the wall when the robot drives. Then beams pass over where it
/// was, too, and one of its ends is seen: that tells nothing but of round things.
bool slides_along_itself(const Body& body, Vec2 laser) {
  const Vec2 chord = body.outline_in_map.back() - body.outline_in_map[0];
  const Vec2 way = body.track.position_in_map - body.anchor_in_map, beam = body.track.position_in_map - laser;
  const bool slanted = std::fabs(dot(chord, beam)) > kSlant * norm(chord) * norm(beam);
  const bool may_be_wall = slanted || (!body.whole && !came_to_free_space(body));
  return may_be_wall && norm(chord) > kChordM && std::fabs(dot(chord, way)) > kAlong * norm(chord) * norm(way);
}

bool ground_says_so(const Body& body, const Surroundings& around, const OldPlace& old) {
  return old.through || came_to_free_space(body) || enters_free_ground(body, around.still);
}

/// Of a steady walk, whether anything else says that it is one: the ground, or both sides of a body that went along for
/// longer than the middle of a heap of posts goes as it shows another side (0.16 m, in BARN).
bool borne_out(const Body& body, const StraightWalk& walk, const Surroundings& around, const OldPlace& old) {
  return ground_says_so(body, around, old) || (rigid(body, walk) && walk.length_m > kStandsWithinM);
}

/// A walk without hops, of a thing whose place is not still taken: steady, where something else bears that out, or
/// longer and swaying, as one leg or the other is seen, when the world agrees twice.
bool walks(const Body& body, const StraightWalk& walk, const Surroundings& around) {
  if (walk.longest_hop_m > kHopM) return false;
  const OldPlace old = old_place(body, around);
  if (old.taken) return false;
  const bool came = came_to_free_space(body), left = old.through;
  const bool told = left || edge_walks(body, walk);
  if (!(told && round(body)) && slides_along_itself(body, around.laser_in_map())) return false;
  if (steady(body, walk) && borne_out(body, walk, around, old)) return true;
  if (came && left) return walk.explained > kExplainedSwaying && walk.length_m > kStandsWithinM;
  const double range_m = distance(around.laser_in_map(), body.track.position_in_map);
  const double far = std::max(2.0 * kPersonRadiusM, (came ? kCamePerM : kPerM) * range_m);
  return (came || body.whole) && walk.explained > kStraightExplains && walk.length_m - walk.width_change_m > far;
}

double gone(const Body& body) { return distance(body.track.position_in_map, body.anchor_in_map); }

bool far_from_anchor(const Body& body, const StraightWalk& walk) {
  const double least_m = steady(body, walk) ? least_steady_m(body, walk) : kStandsWithinM;
  return gone(body) > std::max(least_m, kGoneSigmas * std::sqrt(body.track.covariance.pp));
}

/// Fixed to the robot: masts, cables, a rider's feet that no turn has told from walls yet.
bool rides_along(const Body& body, Vec2 in_laser) {
  return norm(in_laser) < kRidesWithinM && distance(in_laser, body.anchor_in_laser) < kRidesShare * gone(body);
}

bool at_a_walk(const StraightWalk& walk) {
  return walk.length_m > kStoppedMps * walk.duration_s && walk.length_m < kFastMps * walk.duration_s;
}

/// The filter has it walk rather than stand.
bool filter_walks(const Body& body) {
  return norm(body.track.velocity_in_map) > kStoppedMps && body.models.weight(MotionModels::kStands) <= kMayStand;
}

/// Fast against what the filter is unsure of, or steady.
bool beyond_doubt(const Body& body, const StraightWalk& walk) {
  if (edge_walks(body, walk) && at_a_walk(walk)) return true;
  if (!filter_walks(body)) return false;
  return steady(body, walk) || norm(body.track.velocity_in_map) > kSpeedSigmas * std::sqrt(body.track.covariance.vv);
}

bool places_enough(const Body& body, const StraightWalk& walk) {
  return walk.places >= (steady(body, walk) ? kFewestSteady : kFewestPlaces);
}

Departure by_the_whole_path(const Body& body, const Surroundings& around) {
  const StraightWalk walk = body.path.fit();
  if (!places_enough(body, walk) || !far_from_anchor(body, walk) || !beyond_doubt(body, walk)) return Departure::kNone;
  if (!walks(body, walk, around)) return Departure::kNone;
  return rigid(body, walk) ? Departure::kCertain : Departure::kLikely;
}

/// Who stood has walked only since: his newest places alone, after others that he stood at. Both sides of a body must
/// have gone along, its widths no farther apart than a beam explains. Its noise has just grown, since no filter
/// foretold the first step.
bool sets_out(const Body& body, const Surroundings& around) {
  if (!body.whole || !as_wide_as_a_body(body.arc_m) || body.noise > kNoiseSettingOut || !filter_walks(body))
    return false;
  const StraightWalk walk = body.path.latest_walk(kFewestPlaces);
  if (body.path.fit().duration_s - walk.duration_s < kPauseS) return false;
  if (walk.sigmas < kSetsOutSigmas || walk.length_m < kSteadyM) return false;
  if (!keeps_its_width(walk, walk.width_change_m - walk.spacing_m)) return false;
  if (!at_a_walk(walk) || walk.longest_hop_m > kHopM) return false;
  const OldPlace old = old_place(body, around);
  const bool told = old.through && round(body);
  if (old.taken || (!told && slides_along_itself(body, around.laser_in_map()))) return false;
  return ground_says_so(body, around, old);
}

}  // namespace

Departure departure(const Body& body, const Surroundings& around) noexcept {
  if (body.seen_share <= kMostlySeen) return Departure::kNone;
  if (rides_along(body, inverse(around.map_from_laser) * body.track.position_in_map)) return Departure::kNone;
  if (sets_out(body, around)) return Departure::kCertain;  // what is taken for a wall must have stood
  return body.on_wall ? Departure::kNone : by_the_whole_path(body, around);
}

}  // namespace jaywalk
