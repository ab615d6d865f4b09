#include "planner/tracking/motion_onset.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "planner/tracking/tuning.h"

namespace jaywalk {
namespace {
constexpr double kMostlySeen = 0.6;  // of the scans; what flickers is clutter
constexpr double kGoneSigmas = 3.0;
constexpr double kSpeedSigmas = 2.5;
constexpr double kFastMps = 1.8;  // faster than people walk: more often a hop between two like things
constexpr std::size_t kFewestPositions = 5;
// Least share of looks through where it is now, before: 36 of 76 things that would have begun to move where nobody is
// do not any more, and nobody who walks begins later (bench/tracking/recordings.py, 16 headings). From 0.15 to 0.3 the
// same.
constexpr double kSeenThrough = 0.15;
// Least share of looks that went through, from which the target came to free ground. It then needs four positions only,
// its speed is not held against the filter's covariance, and a swaying walk counts (left_its_width). Recording of the
// driving chair: 69 of 84 walkers are shown moving, 54 without this rule (bench/tracking/recordings.py). Simulated
// pedestrians on two legs at 0.8 m/s: 83 % are known within 0.6 s, 74 % where swaying walks do not count
// (bench/worlds.py movers, seeds 901 and 902). The swaying walks add two false movers to 16 passes over no_people_left
// and right.
constexpr double kWasFree = 0.5;
constexpr std::size_t kFewestWasFree = 4;
// Largest range at which an arrival counts, m: beyond it the heading's error moves walls as far. With it 15 of 27
// targets beside the driving wheelchair arrive, and 11 of 569 where nobody is (no_people_left and right).
constexpr double kArrivesWithinM = 5.0;
constexpr double kHopM = 0.5 * kStrideM;   // one leg is seen, then the other
constexpr double kExplainedSwaying = 0.6;  // legs take turns in being seen
constexpr double kMayStand = 0.5;          // probability that it stands, at most
// Of a target that stood: in no_people_left nothing that did came to more than 9.0 by its newest positions, at 8.5 nine
// more of 125 starts set something off. Where it need not have stood a thing in Freiburg does. The noise of those that
// start came to 2.0 in the simulation.
constexpr double kStartsSigmas = 10.0, kQuietNoise = 2.5;
constexpr double kChordM = 0.25, kAlong = 0.7;  // legs are narrower; 45 degrees
constexpr double kSlant = 0.35;                 // 20 degrees off square to the beams
constexpr double kRidesWithinM = 1.2;
constexpr double kRidesShare = 0.6;       // of its way in the map is all that it moved before the laser
constexpr std::uint32_t kOnsetScans = 2;  // in a row: a hop is over by the next scan
// A pedestrian that turns on the spot walks on. Less than the 5 s in which one that stays is to be in the map.
constexpr Duration kSlowFor = duration_from_seconds(4.3);
constexpr Duration kSettleAfter = duration_from_seconds(1.2);

/// What became of the anchor.
struct OldPlace {
  bool taken = false;    ///< beams still end there
  bool through = false;  ///< beams pass over it, or find nothing there
};

bool covers(const Outline& outline, Vec2 place, double within) {
  return std::any_of(outline.begin(), outline.end(), [&](Vec2 p) { return distance(p, place) < within; });
}

/// Of the points seen at the anchor, the half that lies behind on the target's way and that it has left. Beams that end
/// on the target itself say nothing.
OldPlace old_place(const Target& e, const Surroundings& around) {
  OldPlace old;
  const double tolerance = wall_noise_m(distance(around.laser_in_map(), e.position()));
  const Outline& outline = e.onset.anchor_outline;  // in the order of the beams, so that it has two ends
  if (outline.empty()) return old;
  const bool first_lags = dot(outline.back() - outline[0], e.way()) > 0.0;
  for (std::size_t k = 0; k < (outline.size() + 1) / 2; ++k) {
    const Vec2 place = outline[first_lags ? k : outline.size() - 1 - k];
    if (covers(e.appearance.outline_in_map, place, tolerance)) continue;
    const Sight seen = around.sight.at(place, tolerance, e.appearance.beams);
    old.taken = old.taken || seen == Sight::kThere;
    old.through = old.through || seen == Sight::kThrough || seen == Sight::kEmpty;
  }
  return old;
}

/// A piece of wall seen at a slant seems to slide along the wall when the robot drives; beams pass over where it was,
/// too.
bool slides_along_itself(const Target& e, Vec2 laser) {
  const Outline& outline = e.appearance.outline_in_map;
  const Vec2 chord = outline.back() - outline[0], way = e.way(), beam = e.position() - laser;
  const bool slanted = std::fabs(dot(chord, beam)) > kSlant * norm(chord) * norm(beam);
  const bool may_be_wall = slanted || (!e.appearance.whole && !e.onset.came_to_free_space());
  return may_be_wall && norm(chord) > kChordM && std::fabs(dot(chord, way)) > kAlong * norm(chord) * norm(way);
}

/// Whether the walk, less the change of the target's width, is longer than half that width: then the target's middle
/// has passed the place of its edge. Noise above kQuietNoise rules it out: a target that changes its shape has as much.
bool left_its_width(const Target& e, const StraightFit& fit) {
  const Outline& outline = e.appearance.outline_in_map;
  const double half_m = 0.5 * distance(outline[0], outline.back());
  return e.appearance.noise < kQuietNoise && fit.length_m - fit.width_change_m > std::max(kStandsWithinM, half_m);
}

/// Whether the target walks: no hops, and no beam ends at its old place. A steady walk is enough. A swaying walk (the
/// laser sees one leg, then the other) needs two witnesses of the ground: the map had the new place free and beams now
/// pass over the old one, or beams passed over the new place a moment ago (`was_free`). Where the map did not have the
/// new place free, or the target is partly hidden, the walk must be straighter.
bool walks(const Target& e, const StraightFit& fit, const Surroundings& around, bool was_free) {
  if (fit.longest_hop_m > kHopM) return false;
  const OldPlace old = old_place(e, around);
  if (old.taken || slides_along_itself(e, around.laser_in_map())) return false;
  if (steady(e, fit)) return true;
  const bool sways = e.onset.came_to_free_space() && fit.explained > kExplainedSwaying;
  if (sways && old.through && fit.length_m > kStandsWithinM) return true;
  const bool one_line = fit.explained > kStraightExplains || (sways && e.appearance.whole);
  return was_free && one_line && left_its_width(e, fit);
}

bool far_from_anchor(const Target& e, const StraightFit& fit) {
  const double least_m = steady(e, fit) ? least_steady_m(e, fit) : kStandsWithinM;
  return norm(e.way()) > std::max(least_m, kGoneSigmas * std::sqrt(e.estimate.track.covariance.pp));
}

/// Fixed to the robot: masts, cables, a rider's feet that no turn has told from walls yet.
bool rides_along(const Target& e, const Surroundings& around) {
  const double away_m = norm(inverse(around.map_from_laser) * e.position());
  const Vec2 in_first = inverse(around.map_from_first) * e.position();
  return away_m < kRidesWithinM && distance(in_first, e.onset.anchor_in_laser) < kRidesShare * norm(e.way());
}

bool at_a_walk(const StraightFit& fit) {
  return fit.length_m > kStoppedMps * fit.duration_s && fit.length_m < kFastMps * fit.duration_s;
}

/// The filter has it walk rather than stand.
bool filter_walks(const Estimate& estimate) {
  return norm(estimate.track.velocity_in_map) > kStoppedMps && estimate.filter.weight(ImmFilter::kStands) <= kMayStand;
}

/// Whether the filter has the target walk, and one thing more supports it: its place was free a moment ago, the walk is
/// steady, or its speed is large against the speed's standard deviation.
bool beyond_doubt(const Target& e, const StraightFit& fit, bool was_free) {
  if (!filter_walks(e.estimate)) return false;
  const Track& track = e.estimate.track;
  return was_free || steady(e, fit) || norm(track.velocity_in_map) > kSpeedSigmas * std::sqrt(track.covariance.vv);
}

MotionOnset by_all_positions(const Target& e, const Surroundings& around, bool was_free) {
  const StraightFit fit = e.onset.positions.fit();
  if (fit.positions < (was_free ? kFewestWasFree : kFewestPositions) || !far_from_anchor(e, fit) ||
      !beyond_doubt(e, fit, was_free))
    return MotionOnset::kNone;
  if (!walks(e, fit, around, was_free)) return MotionOnset::kNone;
  return rigid(e, fit) ? MotionOnset::kCertain : MotionOnset::kLikely;
}

/// A target that stood has walked only since: its newest positions alone, after others that it stood at. Both sides of
/// a body must have gone along, its widths no farther apart than a beam explains. Its noise has just grown, since no
/// filter foretold the first step.
bool starts(const Target& e, const Surroundings& around) {
  const Appearance& seen = e.appearance;
  if (!seen.whole || !as_wide_as_a_body(seen.arc_m) || seen.noise > kQuietNoise || !filter_walks(e.estimate))
    return false;
  const StraightFit fit = e.onset.positions.fit_newest(kFewestPositions);
  if (e.onset.positions.fit().duration_s - fit.duration_s < kPauseS) return false;
  if (fit.sigmas < kStartsSigmas || fit.length_m < kSteadyM) return false;
  if (!keeps_its_width(fit, fit.width_change_m - fit.spacing_m)) return false;
  if (!at_a_walk(fit) || fit.longest_hop_m > kHopM) return false;
  return !slides_along_itself(e, around.laser_in_map());
}

void judge_moving(Target& target, const Surroundings& around) {
  Time& slow_since = target.onset.slow_since;
  if (norm(target.estimate.track.velocity_in_map) >= kStoppedMps) {
    slow_since = kNever;
    return;
  }
  if (slow_since == kNever) slow_since = around.now;
  if (around.now - slow_since < kSlowFor) return;
  target.estimate.track.moving = false;
  anchor_here(target, around.map_from_first, around.now);
  target.onset.anchored = std::exchange(slow_since, kNever);  // it has stood here for as long as it was slow
}

void note_onset(std::uint32_t& onsets, MotionOnset seen) {
  onsets = seen == MotionOnset::kNone ? 0 : onsets + (seen == MotionOnset::kCertain ? kOnsetScans : 1);
}

void begin_moving(Target& target) {
  target.onset.onsets = 0;
  target.estimate.track.moving = true;
  target.estimate.filter.date_back(target.estimate.track, target.estimate.late_s);
  target.existence.settled = false;
}

std::optional<double> seen_through(const Target& target, const Surroundings& around) {
  const Outline& outline = target.appearance.outline_in_map;
  return around.past.seen_through({outline.begin(), outline.size()}, around.now);
}

/// Notes the arrival of a target: over some scans, most beams of the last second passed through its place.
void note_arrival(Target& target, const Surroundings& around) {
  const Outline& outline = target.appearance.outline_in_map;
  if (target.existence.misses > 0 || !target.appearance.whole || distance(outline[0], outline.back()) > kBodyAcrossM)
    return;
  if (distance(target.estimate.track.position_in_map, around.laser_in_map()) > kArrivesWithinM) return;
  const auto through = seen_through(target, around);
  if (!through) return;
  double& mean = target.onset.came_share;
  mean += kMeanGain * (*through - mean);
  if (mean > kWasFree) target.existence.pedestrian.came();
}

void judge_standing(Target& target, const Surroundings& around) {
  if (target.existence.misses == 0) note_onset(target.onset.onsets, motion_onset(target, around));
  note_arrival(target, around);
  if (target.onset.onsets >= kOnsetScans) return begin_moving(target);
  const Duration stood = around.now - target.onset.anchored;
  if (stood > kSettleAfter && norm(target.way()) < kStandsWithinM) target.existence.settled = true;
  if (stood > kMayGoOnWithin) anchor_here(target, around.map_from_first, around.now);  // creeping is not walking
}

/// Not called moving, and no wall: a pedestrian that goes along beside the robot.
bool came_along(const Target& e) {
  return e.appearance.solid() && e.appearance.whole && e.onset.came_to_free_space() &&
         norm(e.way()) > 2.0 * kPersonRadiusM;
}

}  // namespace

MotionOnset motion_onset(const Target& target, const Surroundings& around) noexcept {
  if (target.existence.seen_share <= kMostlySeen) return MotionOnset::kNone;
  const auto through = seen_through(target, around);
  if (through.value_or(1.0) < kSeenThrough) return MotionOnset::kNone;
  if (rides_along(target, around)) return MotionOnset::kNone;
  if (starts(target, around)) return MotionOnset::kCertain;  // what is taken for a wall must have stood
  return target.appearance.on_wall ? MotionOnset::kNone
                                   : by_all_positions(target, around, through.value_or(0.0) >= kWasFree);
}

void judge_motion(Target& target, const Surroundings& around) noexcept {
  if (target.existence.given) return;
  if (target.estimate.track.moving) {
    judge_moving(target, around);
  } else {
    judge_standing(target, around);
  }
  if (target.estimate.track.moving || (target.confirmed() && came_along(target))) target.existence.pedestrian.walks();
}

void forget_walk(Target& target, const Pose2& map_from_laser, Time now) noexcept {
  target.onset.positions.clear();
  target.onset.onsets = 0;
  anchor_here(target, map_from_laser, now);
}

}  // namespace jaywalk
