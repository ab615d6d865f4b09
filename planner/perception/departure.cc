#include "planner/perception/departure.h"

#include <algorithm>
#include <cmath>

#include "planner/perception/places.h"

namespace jaywalk {
namespace {

constexpr double kMostlySeen = 0.6;  // of the scans; what flickers is clutter
constexpr double kMostlyFree = 0.7;  // of its places in free space
constexpr double kGoneM = 0.25;      // from the anchor: half of a step, more than a person's swaying
constexpr double kGoneSigmas = 3.0;
constexpr double kMovingMps = 0.15;  // slower than this is noise of the legs' mean
constexpr double kSpeedSigmas = 2.5;
constexpr double kFastMps = 1.8;  // faster than people walk: more often a hop between two like things
constexpr std::size_t kPlacesWhenFast = 8;
constexpr std::size_t kFewestPlaces = 5, kFewestSteady = 4;
constexpr double kHopM = 0.3;              // half of a stride: one leg is seen, then the other
constexpr double kExplained = 0.8;         // by a straight walk: one hop reaches 0.75
constexpr double kExplainedSwaying = 0.6;  // legs take turns in being seen
constexpr double kStrideM = 0.5;
constexpr double kPerM = 0.1, kCamePerM = 0.2;  // of the walk, a metre of range: 0.1 is 6 degrees of heading
constexpr double kMayStand = 0.5;               // probability that it stands, at most
constexpr double kSolidSigmas = 7.0, kThingSigmas = 15.0, kSteadyM = 0.10;  // of a steady walk
// The same of bodies that came to free space: no false mover in no_people_left.
constexpr double kCameSigmas = 4.5, kCameM = 0.06;
constexpr double kRigidShare = 0.3;  // of its walk is all that its width changes by
// Of one who stood: in no_people_left nothing that did came to more than 9.0 by its newest places, at 8.5 nine more of
// 125 starts set something off. Who need not have stood: a thing in Freiburg does. The noise of who sets out came
// to 2.0 in the simulation (docs/tracking-findings.md, "Setting out").
constexpr double kStoodS = 0.4, kSetsOutSigmas = 10.0, kNoiseSettingOut = 2.5;
constexpr double kEdges = 1.5;  // beam spacings: where its free side is, is known to one
constexpr double kPartM = 0.5;  // of a body: what is wider has its middle where more of it comes into view
constexpr double kChordM = 0.25, kAlong = 0.7;  // legs are narrower; 45 degrees
constexpr double kSlant = 0.35;                 // 20 degrees off square to the beams
constexpr double kRidesWithinM = 1.2;
constexpr double kRidesShare = 0.6;  // of its way in the map is all that it moved before the laser

bool came_to_free_space(const Body& body) { return body.free_share > kMostlyFree; }

/// Comes out from behind something wider than legs, which no leg that takes its turn does. Its free side is where its
/// path is measured, and a surface that comes into view has that where it always was.
bool emerges(const Body& body, const StraightWalk& walk) {
  return body.edge_m > 0.0 && body.noise < Body::kSolidNoise && walk.widest_m < kPartM;
}

bool came_straight(const Body& body, const StraightWalk& walk) {
  return came_to_free_space(body) && walk.explained > kExplained;
}

/// The least of a steady walk that is believed: the more the body and the ground tell, the less.
struct LeastWalk {
  double sigmas = 0.0, length_m = 0.0;
};

LeastWalk least_walk(const Body& body, const StraightWalk& walk) {
  if (!body.solid() && !emerges(body, walk)) return {kThingSigmas, kSteadyM};
  if (came_straight(body, walk)) return {kCameSigmas, kCameM};
  return {kSolidSigmas, kSteadyM};
}

/// So straight for its length that there is no doubt left, and longer than growing or shrinking explains: a slow robot
/// is both slow and straight, a person fast and swaying.
bool steady(const Body& body, const StraightWalk& walk) {
  const LeastWalk least = least_walk(body, walk);
  return walk.sigmas > least.sigmas &&
         walk.length_m > std::max({least.length_m, walk.width_change_m, kEdges * body.edge_m});
}

/// Both its sides went along, and nothing hides either: no surface that comes into view does that.
bool rigid(const Body& body, const StraightWalk& walk) {
  return body.whole && body.solid() && steady(body, walk) && walk.width_change_m < kRigidShare * walk.length_m;
}

/// What its free side went says more, and sooner, than a filter that does not know yet how wide it is.
bool edge_walks(const Body& body, const StraightWalk& walk) { return emerges(body, walk) && steady(body, walk); }

/// A piece of wall seen at a slant seems to slide along the wall when the robot drives.
bool slides_along_itself(const Body& body, Vec2 laser) {
  const Vec2 chord = body.outline_in_map.back() - body.outline_in_map[0];
  const Vec2 way = body.track.position_in_map - body.anchor_in_map, beam = body.track.position_in_map - laser;
  const bool slanted = std::fabs(dot(chord, beam)) > kSlant * norm(chord) * norm(beam);
  const bool may_be_wall = slanted || (!body.whole && !came_to_free_space(body));
  return may_be_wall && norm(chord) > kChordM && std::fabs(dot(chord, way)) > kAlong * norm(chord) * norm(way);
}

/// A walk without hops, of a thing whose place is not still taken: steady, where the ground says so as well, or longer
/// and swaying, as one leg or the other is seen, when the world agrees twice.
bool walks(const Body& body, const StraightWalk& walk, const Surroundings& around) {
  if (walk.longest_hop_m > kHopM) return false;
  const OldPlace old = old_place(body, around);
  if (old.taken) return false;
  const bool came = came_to_free_space(body), left = old.through;
  if (!left && !edge_walks(body, walk) && slides_along_itself(body, around.laser_in_map())) return false;
  if (steady(body, walk) && (came || left || enters_free_ground(body, around.still))) return true;
  if (came && left) return walk.explained > kExplainedSwaying && walk.length_m > kGoneM;
  const double range_m = distance(around.laser_in_map(), body.track.position_in_map);
  const double far = std::max(kStrideM, (came ? kCamePerM : kPerM) * range_m);
  return (came || body.whole) && walk.explained > kExplained && walk.length_m - walk.width_change_m > far;
}

double gone(const Body& body) { return distance(body.track.position_in_map, body.anchor_in_map); }

bool far_from_anchor(const Body& body, const StraightWalk& walk) {
  if (edge_walks(body, walk)) return true;
  const double least_m = steady(body, walk) ? least_walk(body, walk).length_m : kGoneM;
  return gone(body) > std::max(least_m, kGoneSigmas * std::sqrt(body.track.covariance.pp));
}

/// Fixed to the robot: masts, cables, a rider's feet that no turn has told from walls yet.
bool rides_along(const Body& body, Vec2 in_laser) {
  return norm(in_laser) < kRidesWithinM && distance(in_laser, body.anchor_in_laser) < kRidesShare * gone(body);
}

bool at_a_walk(const StraightWalk& walk) {
  return walk.length_m > kMovingMps * walk.duration_s && walk.length_m < kFastMps * walk.duration_s;
}

/// The filter has it walk rather than stand.
bool filter_walks(const Body& body) {
  return norm(body.track.velocity_in_map) > kMovingMps && body.models.weight(MotionModels::kStands) <= kMayStand;
}

/// Fast against what the filter is unsure of, or steady.
bool beyond_doubt(const Body& body, const StraightWalk& walk) {
  if (edge_walks(body, walk) && at_a_walk(walk)) return true;
  if (!filter_walks(body)) return false;
  const double speed = norm(body.track.velocity_in_map);
  if (speed > kFastMps && walk.places < kPlacesWhenFast) return false;
  return steady(body, walk) || speed > kSpeedSigmas * std::sqrt(body.track.covariance.vv);
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
  if (body.path.fit().duration_s - walk.duration_s < kStoodS) return false;
  const double grew_m = walk.width_change_m - walk.spacing_m;
  if (walk.sigmas < kSetsOutSigmas || walk.length_m < kSteadyM || grew_m > kRigidShare * walk.length_m) return false;
  if (!at_a_walk(walk) || walk.longest_hop_m > kHopM) return false;
  const OldPlace old = old_place(body, around);
  if (old.taken || (!old.through && slides_along_itself(body, around.laser_in_map()))) return false;
  return old.through || came_to_free_space(body) || enters_free_ground(body, around.still);
}

}  // namespace

Departure departure(const Body& body, const Surroundings& around) noexcept {
  if (body.seen_share <= kMostlySeen) return Departure::kNone;
  if (rides_along(body, inverse(around.map_from_laser) * body.track.position_in_map)) return Departure::kNone;
  if (sets_out(body, around)) return Departure::kCertain;  // what is taken for a wall must have stood
  return body.on_wall ? Departure::kNone : by_the_whole_path(body, around);
}

}  // namespace jaywalk
