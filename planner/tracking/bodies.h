#pragma once
// Bodies: tracks with what the tracker alone needs to know of them.
#include <cstdint>

#include "hal/types/fixed_vector.h"
#include "planner/tracking/clusters.h"
#include "planner/tracking/motion_models.h"
#include "planner/tracking/recent_path.h"
#include "planner/tracking/track.h"

namespace jaywalk {

struct Body {
  Track track;
  Track as_seen;  ///< the same when it was seen last
  MotionModels models;
  RecentPath path;
  double noise = 1.0;       ///< variance of where it is seen, in units of what its kind of observation should have
  double arc_m = 0.0;       ///< running mean of half its width where it was seen whole; 0: never, or only its legs
  double legs_share = 0.0;  ///< running mean: how many of the sights showed two legs apart
  /// How far its middle may be from where it is seen, m an axis, scan after scan: its width is known to half a beam's
  /// spacing, or not at all. A filter of places follows what is seen and cannot tell; it is added to what is published,
  /// as a bias that is considered and not estimated (Schmidt 1966).
  double off_std_m = 0.0;
  double late_s = 0.0;         ///< when it was seen last, after that scan's stamp
  bool whole = false;          ///< when it was seen last, nothing hid either side of it
  int hidden_side = 0;         ///< Cluster::hidden_side then
  bool on_wall = false;        ///< and it stood where walls stand
  double edge_m = 0.0;         ///< how well its free side was seen then, behind something wider than legs; 0: not so
  bool given = false;          ///< named by an outside system; the laser does not judge it
  std::uint32_t given_id = 0;  ///< that system's own name for it
  Time born = kNever;
  double seen_share = 1.0;        ///< running mean: how many of the scans saw it
  double free_share = 0.0;        ///< running mean: how much of the time it was seen where nothing stood before
  Time still_since = kNever;      ///< since when it has stood near `anchor`
  Vec2 anchor_in_map;             ///< where it last stood, or was born
  Outline anchor_outline;         ///< points of it that were seen there, in the map
  bool anchor_low_seen = false;   ///< nothing hid its first beams' side there
  bool anchor_high_seen = false;  ///< nor its last beams'
  Vec2 anchor_in_laser;           ///< the same, seen from where the laser was then
  Time slow_since = kNever;       ///< since when a moving one has been too slow to be called so; kNever: it is not
  double looked_through_s = 0.0;  ///< for how long beams have passed through where it should be
  Outline outline_in_map;         ///< points of it that were seen last
  BeamRun beams;                  ///< that ended on it then
  std::uint32_t misses = 0;       ///< scans in a row that did not see it
  std::uint32_t walked = 0;       ///< scans in a row that it seemed to walk in
  bool somebody = false;          ///< for all that is known: it walked, or stood on two legs
  bool settled = false;           ///< stands for good: its points may become walls

  /// How long after its track's stamp what was measured `after_s` after the scan's was. Who moves is brought to the
  /// scan's stamp; who is not known to move is where he is seen, whenever that is.
  [[nodiscard]] double late_by(double after_s) const { return track.moving ? after_s : 0.0; }
  /// When it was seen last, nothing hid its first beams' side.
  [[nodiscard]] bool low_seen() const { return whole || hidden_side > 0; }
  /// Nor its last beams'.
  [[nodiscard]] bool high_seen() const { return whole || hidden_side < 0; }
  /// Seen often enough to be believed; others are kept to themselves.
  [[nodiscard]] bool confirmed() const { return given || track.hits >= 3; }
  /// Two legs that pass each other are as wide as a body now and then, and no arc of one.
  [[nodiscard]] bool on_legs() const { return legs_share > kOnLegs; }
  /// As wide as people and robots are, and seen to stay where it should be as solid things do.
  [[nodiscard]] bool solid() const { return as_wide_as_a_body(arc_m) && noise < kSolidNoise; }

  static constexpr double kSolidNoise = 1.5;  ///< legs and corners that change places have more
  static constexpr double kOnLegs = 0.25;     ///< chosen: of who walks most sights do, of a disc none
};

/// Beams that all pass over so much of a body's place pass through it, and for so long: it is gone.
inline constexpr double kEmptyWithinM = 0.1, kLookedThroughForS = 0.3;
/// Of running means over sights, a scan: the last three make half of one.
inline constexpr double kMeanGain = 0.2;
/// A body known for less is believed in no longer when it is not seen for as long, s: dark cloth returns nothing for
/// half a second, and its speed is not worth going by.
inline constexpr double kTentativeS = 0.6;
/// Unseen for longer, s, a body may be another; and one that stood for as long has walked only since.
inline constexpr double kPauseS = 0.4;
/// What has not gone farther than half of a step stands, m: more than a pedestrian sways.
inline constexpr double kStandsWithinM = 0.25;
/// What turns on the spot has walked on by then, and 5 s are what a body that stays may take to become still.
inline constexpr Duration kMayGoOnWithin = duration_from_seconds(3.0);
/// A body that is not seen is predicted for so long, s: then it may have turned or stopped.
inline constexpr double kForeseenS = 1.0;
/// Points this near a body's outline are its own.
inline constexpr double kSkinM = 0.15;

using Bodies = FixedVector<Body, kMaxTracks>;

/// A body seen for the first time at `position_in_map`: it may be walking already, 1 m/s an axis.
[[nodiscard]] Body born_at(Vec2 position_in_map, double std_m, double radius_m, Time now, std::uint32_t id) noexcept;

/// From now on the body is watched for going away from where it now is, and was just seen.
void anchor_here(Body& body, const Pose2& map_from_laser, Time now) noexcept;

/// It was `by_m` from where it was taken to be, all the time.
void move_all(Body& body, Vec2 by_m) noexcept;

/// What was seen of its way until now tells nothing.
void forget_walk(Body& body, const Pose2& map_from_laser, Time now) noexcept;

/// Adds `newcomer`. When there are kMaxTracks already, the one farthest from the robot goes, of those that stand where
/// walls stand if there are any; and that may be the newcomer.
void admit(Bodies& bodies, const Body& newcomer, Vec2 robot_in_map) noexcept;

}  // namespace jaywalk
