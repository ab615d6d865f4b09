#pragma once
// Targets of the tracker: what is known of each, from one scan or outside report to the next.
#include <cstdint>

#include "hal/types/fixed_vector.h"
#include "hal/types/outside_fix.h"
#include "planner/scan/scan_points.h"
#include "planner/tracking/detection.h"
#include "planner/tracking/imm_filter.h"
#include "planner/tracking/pedestrian_belief.h"
#include "planner/tracking/straight_fit.h"
#include "planner/tracking/track.h"

namespace jaywalk {

/// Appearance of a body's nearest detection.
struct Look {
  Outline outline_in_map;  ///< some of its points
  BeamRun beams{};         ///< that ended on it
  bool whole = false;      ///< nothing hid either side of it
  int hidden_side = 0;     ///< Detection::hidden_side
  bool on_wall = false;    ///< it stood where walls stand
};

/// What one scan says of a body: one detection, or a person's two legs. A field a measurement, so more of them than a
/// struct has elsewhere.
struct Observation : Look {
  Vec2 position_in_map;
  double late_s = 0.0, late_std_s = 0.0;  ///< Detection's: when it was there
  double std_m = 0.0;                     ///< an axis, as expected of its kind; Target::noise tells what comes of it
  double off_std_m = 0.0;                 ///< besides, an axis: Target's
  double radius_m = 0.0;
  bool in_free_space = false;
  double width_m = 0.0;    ///< of what is seen of the nearest detection
  double spacing_m = 0.0;  ///< from beam to beam, across them
  double arc_m = 0.0;      ///< half its width across the beams where it is whole and no leg; else 0
  bool two_legs = false;   ///< apart, with nothing before either
  bool lone_leg = false;   ///< one leg alone
  Vec2 was_off;            ///< m: how far from there one side alone has had it until now that both are seen
};

/// `lead` alone, or it and another leg, `fellow`, -1 for none. `arc_m`, `on_legs`: Target's.
[[nodiscard]] Observation observation_of(const Detections& detections, std::size_t lead, std::int32_t fellow,
                                         double arc_m, bool on_legs) noexcept;

/// From where one side of `c` had its middle while its width was not known (`hidden_side`: Target's), to where both
/// have it.
[[nodiscard]] Vec2 off_by_one_side(const Detection& c, int hidden_side) noexcept;

// What the tracker knows of a target, in four parts: a rule is given only those that it reads.

/// Where the target is and how fast it moves.
struct Estimate {
  Track track;
  Track as_seen;  ///< the track as it was when a scan saw it last
  ImmFilter filter;
  Vec2 still_at;  ///< m in the map: near there, or creeping on from there, the track has been since Track::still_since
  /// How far its middle may be from where it is seen, m an axis, scan after scan: its width is known to half a beam's
  /// spacing, or not at all. A filter of positions follows what is seen and cannot tell; it is added to what is
  /// published, as a bias that is considered and not estimated (Schmidt 1966).
  double off_std_m = 0.0;
  double late_s = 0.0;  ///< when it was seen last, after that scan's stamp

  /// How long after the track's stamp a detection was measured, `after_s` after its scan's. A moving track is brought
  /// to the scan's stamp; one not known to move is where it is seen, whenever that is.
  [[nodiscard]] double late_by(double after_s) const { return track.moving ? after_s : 0.0; }
};

/// What the last detection looked like, and what many of them say of its size.
struct Appearance : Look {
  double noise = 1.0;       ///< variance of its position, in units of what its kind of observation should have
  double arc_m = 0.0;       ///< running mean of half its width where it was seen whole; 0: never, or only its legs
  double legs_share = 0.0;  ///< running mean: how many of the detections were two legs apart

  /// Two legs that pass each other are as wide as a body now and then, and no arc of one.
  [[nodiscard]] bool on_legs() const { return legs_share > kOnLegs; }
  /// As wide as people and robots are, and seen to stay where it should be as solid things do.
  [[nodiscard]] bool solid() const { return as_wide_as_a_body(arc_m) && noise < kSolidNoise; }

  static constexpr double kSolidNoise = 1.5;  ///< legs and corners that change places have more
  static constexpr double kOnLegs = 0.25;     ///< chosen: most detections of a pedestrian show two legs, of a disc none
};

/// What tells whether the target started moving.
struct OnsetHistory {
  PositionHistory positions;
  double free_share = 0.0;   ///< running mean: share of the detections on ground that was free before
  double came_share = 0.0;   ///< running mean: share of looks that went through where it is, a moment before
  Time anchored = kNever;    ///< since when it is watched for going away from the anchor
  Vec2 anchor_in_map;        ///< where it was then
  Outline anchor_outline;    ///< points of it that were seen there, in the map
  Vec2 anchor_in_laser;      ///< the anchor, seen from where the robot's first laser was then
  Time slow_since = kNever;  ///< since when a moving track has been below kStoppedMps; kNever: it is not
  std::uint32_t onsets = 0;  ///< scans in a row that saw it start moving

  /// It was seen where nothing stood before, most of the time.
  [[nodiscard]] bool came_to_free_space() const { return free_share > kMostlyFree; }

  static constexpr double kMostlyFree = 0.7;
};

/// Whether there is such a target, and of which kind.
struct Existence {
  bool given = false;          ///< named by an outside system; the laser does not judge it
  std::uint32_t given_id = 0;  ///< that system's own name for it
  Time born = kNever;
  double seen_share = 1.0;        ///< running mean: share of the scans that saw it
  double looked_through_s = 0.0;  ///< for how long beams have passed through where it should be
  std::uint32_t misses = 0;       ///< scans in a row that did not see it, from the first of its finder's on
  std::size_t finder = 0;         ///< the scanner that saw it last
  bool scan_counts = true;        ///< the newest scan is a hit or a miss of it; that of another scanner may be neither
  PedestrianBelief pedestrian{};  ///< that it is one
  bool settled = false;           ///< stands for good: its points may become walls

  /// Seen often enough to be published.
  [[nodiscard]] bool confirmed(const Track& track) const { return given || track.hits >= 3; }
};

/// A track with what the tracker alone needs to know of it.
struct Target {
  Estimate estimate;
  Appearance appearance;
  OnsetHistory onset;
  Existence existence;

  [[nodiscard]] bool confirmed() const { return existence.confirmed(estimate.track); }
  [[nodiscard]] Vec2 position() const { return estimate.track.position_in_map; }
  /// From the anchor to where it is, in the map.
  [[nodiscard]] Vec2 way() const { return position() - onset.anchor_in_map; }
};

using Targets = FixedVector<Target, kMaxTracks>;

/// A target seen for the first time at `position_in_map`: it may be walking already, 1 m/s an axis.
[[nodiscard]] Target born_at(Vec2 position_in_map, double std_m, double radius_m, Time now, std::uint32_t id) noexcept;

/// From now on it is watched for going away from where it is, and was just seen.
void anchor_here(Target& target, const Pose2& map_from_laser, Time now) noexcept;

/// It was `by_m` from where it was taken to be, all the time.
void move_all(Estimate& estimate, OnsetHistory& onset, Vec2 by_m) noexcept;

/// Adds `newcomer`. When there are kMaxTracks already, the one farthest from the robot goes, of those that stand where
/// walls stand if there are any; and that may be the newcomer.
void admit(Targets& targets, const Target& newcomer, Vec2 robot_in_map) noexcept;

/// From one scan or report to the next, s: 0 where there was none before or time went back, and 1 at most, since those
/// farther apart tell no velocity.
[[nodiscard]] double step_seconds(Time from, Time to) noexcept;

/// Moves a target on to where it should be at `stamp`, by its filter or, where it is `given` from outside, as the
/// paper's movers go on. A stamp before its own changes nothing.
void predict_to(Estimate& estimate, bool given, Time stamp) noexcept;

/// `target`, predicted to `now`, was seen: corrects its track and what is known of it besides.
void update_with(Target& target, const Observation& seen, const Pose2& map_from_laser, Time now) noexcept;

/// What is kept of how a target was seen last, and nothing else.
void note_seen(Estimate& estimate, Appearance& appearance, const Observation& seen) noexcept;

/// Corrects the bodies that `fix` names, a Kalman filter each, and adds those it names first: `last_id` is the newest
/// track's. Where there is no room, the one farthest from the robot goes. What is no number, or wider than 2 m, is
/// passed over.
void take_given(const OutsideFix& fix, Vec2 robot_in_map, Targets& targets, std::uint32_t& last_id) noexcept;

/// Gives every detection to the likeliest target within its gate (Detection::track_id), of two as near by their own
/// doubt to the surer one; several may share one. Order of targets and detections does not matter except between exact
/// equals.
void associate(const Targets& targets, Detections& detections) noexcept;

/// What the detections given to `target` say together. Its nearest detection leads; when it is a leg, the nearest
/// other leg within a stride joins it. Detections that are left over and too far to belong are set free again.
/// False when it got none.
bool observe(const Track& track, const Appearance& known, Detections& detections, Observation& out) noexcept;

/// A new target's observation from free detection `index` and, for a leg, its nearest free fellow; both are given to
/// the track that it becomes. False, and nothing changes, when the detection is sparse and has no fellow.
[[nodiscard]] bool observe_new(Detections& detections, std::size_t index, std::uint32_t becomes_track_id,
                               Observation& out) noexcept;

/// Cuts segments where one known target ends and the next begins: pedestrians that pass so near that no jump parts
/// them. A segment is cut that begins on one and ends on another, one of which moves at least, and that is about as
/// wide as both.
void split_detections(const Targets& targets, const PointsInMap& in_map, Segments& segments) noexcept;

}  // namespace jaywalk
