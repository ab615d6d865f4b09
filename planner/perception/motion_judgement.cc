#include "planner/perception/motion_judgement.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

constexpr double kMovingMps = 0.15;  // slower than this is noise of the legs' mean
constexpr double kStoppedMps = 0.10;
constexpr std::size_t kSteadyPlaces = 8;
constexpr double kSteady = 0.96;  // explained
constexpr double kSteadyM = 0.15;
constexpr double kExplainedSwaying = 0.6;
constexpr double kStrideM = 0.5;
constexpr double kStridePerM = 0.12;  // of range: far legs are few points, and a heading's error grows
constexpr double kFastMps = 1.8;      // faster than people walk: more often a hop between two like things
constexpr std::size_t kPlacesWhenFast = 8;
constexpr double kRidesWithinM = 1.2;
constexpr double kRidesShare = 0.3;  // of its way in the map is all that it moved before the laser
constexpr double kMostlySeen = 0.7;  // of the scans; what flickers is clutter
constexpr double kMostlyFree = 0.7;  // of its places in free space
constexpr double kSpeedSigmas = 3.0;
constexpr double kGoneM = 0.25;  // from the anchor: half of a step, more than a person's swaying
constexpr double kGoneSigmas = 3.0;
constexpr std::size_t kFewestPlaces = 5;
constexpr double kExplained = 0.85;  // by a straight walk: one hop reaches 0.75
constexpr Duration kSlowFor = duration_from_seconds(1.0);
constexpr Duration kSettleAfter = duration_from_seconds(1.2);
constexpr Duration kAnchorHolds = duration_from_seconds(3.0);

void anchor_here(Body& body, const Pose2& map_from_laser, Time now) {
  body.anchor_in_map = body.track.position_in_map;
  body.anchor_in_laser = inverse(map_from_laser) * body.track.position_in_map;
  body.still_since = now;
}

bool came_to_free_space(const Body& body) { return body.free_share > kMostlyFree; }

bool left_free_space_behind(const Body& body, const EvidenceMap& still) {
  return still.seen_free(still.cell_at(body.anchor_in_map));
}

/// A straight walk that the world agrees with; or a longer one that sways, as one leg or the other is seen, when the
/// world agrees twice.
bool walks(const Body& body, const StraightWalk& walk, const EvidenceMap& still, double range) {
  const bool came = came_to_free_space(body), left = left_free_space_behind(body, still);
  if (walk.explained > kExplained && (came || left)) return true;
  return walk.explained > kExplainedSwaying && walk.length_m > std::max(kStrideM, kStridePerM * range) && came && left;
}

/// So straight that there is no doubt left: a slow robot is both slow and straight, a person fast and swaying.
bool steady(const StraightWalk& walk) {
  return walk.places >= kSteadyPlaces && walk.explained > kSteady && walk.length_m > kSteadyM;
}

double gone(const Body& body) { return distance(body.track.position_in_map, body.anchor_in_map); }

bool far_from_anchor(const Body& body) {
  return gone(body) > std::max(kGoneM, kGoneSigmas * std::sqrt(body.track.covariance.pp));
}

/// Fixed to the robot: masts, cables, a rider's feet that no turn has told from walls yet.
bool rides_along(const Body& body, Vec2 in_laser) {
  return norm(in_laser) < kRidesWithinM && distance(in_laser, body.anchor_in_laser) < kRidesShare * gone(body);
}

/// Fast against what the filter is unsure of, or steady.
bool beyond_doubt(const Body& body, const StraightWalk& walk) {
  const double speed = norm(body.track.velocity_in_map);
  if (speed < kMovingMps || (speed > kFastMps && walk.places < kPlacesWhenFast)) return false;
  return steady(walk) || speed > kSpeedSigmas * std::sqrt(body.track.covariance.vv);
}

/// Seen steadily, gone from where it stood, and walking.
bool sets_out(const Body& body, const EvidenceMap& still, const Pose2& map_from_laser) {
  if (body.misses > 0 || body.seen_share <= kMostlySeen) return false;
  const StraightWalk walk = body.path.fit();
  const Vec2 in_laser = inverse(map_from_laser) * body.track.position_in_map;
  return walk.places >= kFewestPlaces && far_from_anchor(body) && beyond_doubt(body, walk) &&
         walks(body, walk, still, norm(in_laser)) && !rides_along(body, in_laser);
}

/// Slow by its filtered speed, or by its places: jitter has speed and goes nowhere.
bool slow(const Body& body) {
  const StraightWalk walk = body.path.fit();
  const bool goes_nowhere =
      body.misses == 0 && walk.places >= kFewestPlaces && walk.length_m < kStoppedMps * walk.duration_s;
  return goes_nowhere || norm(body.track.velocity_in_map) < kStoppedMps;
}

void judge_mover(Body& body, const Pose2& map_from_laser, Time now) {
  if (!slow(body)) {
    body.slow_since = kNever;
    return;
  }
  if (body.slow_since == kNever) body.slow_since = now;
  if (now - body.slow_since < kSlowFor) return;
  body.track.moving = false;
  body.slow_since = kNever;
  anchor_here(body, map_from_laser, now);
}

void judge_stander(Body& body, const EvidenceMap& still, const Pose2& map_from_laser, Time now) {
  if (sets_out(body, still, map_from_laser)) {
    body.track.moving = true;
    body.settled = false;
    return;
  }
  const Duration stood = now - body.still_since;
  if (stood > kSettleAfter && gone(body) < kGoneM) body.settled = true;
  if (stood > kAnchorHolds) anchor_here(body, map_from_laser, now);  // creeping is not walking
}

}  // namespace

void judge_motion(Body& body, const EvidenceMap& still, const Pose2& map_from_laser, Time now) noexcept {
  if (body.given) return;
  if (body.track.moving) {
    judge_mover(body, map_from_laser, now);
  } else {
    judge_stander(body, still, map_from_laser, now);
  }
}

}  // namespace jaywalk
