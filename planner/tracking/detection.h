#pragma once
// Detections: pieces of a scan that stand where nothing stood before, or as people do. Clearing of isolated obstacles.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hal/types/fixed_vector.h"
#include "planner/mapping/evidence_map.h"
#include "planner/mapping/map_entry.h"
#include "planner/scan/scan_points.h"

namespace jaywalk {
/// Some of the points that something was seen by, spread over its width.
using Outline = FixedVector<Vec2, 5>;

/// Wider things are walls, m: a trolley and the pedestrian that pushes it, from the side, are not.
inline constexpr double kWidestBodyM = 1.6;

/// Of a body that was not seen whole yet, m.
inline constexpr double kPersonRadiusM = 0.25;

/// Legs reach so far from their middle, m: shins 0.16 (hal/sim/world.cc). What a pedestrian leans on is farther.
inline constexpr double kLegsReachM = 0.2;

/// One of a pedestrian's legs is at most so far from the other, m, in mid-step.
inline constexpr double kStrideM = 0.6;

/// Widest obstacle that may be a pedestrian's body, m across: shoulders, and a bag or a coat. No data on its choice.
inline constexpr double kBodyAcrossM = 0.7;

/// As wide as people and robots are, by half the width of what is seen whole: no post. What is too wide is no
/// detection.
[[nodiscard]] constexpr bool as_wide_as_a_body(double half_width_m) { return half_width_m > 0.18; }

/// What the beam beside a detection says of that end of it.
enum class End : std::uint8_t {
  kUnknown,  ///< it returned nothing: what is seen at a slant may go on unseen
  kSeen,     ///< it goes on beyond
  kHidden,   ///< it ends on something nearer, be it the robot's own, or the sweep is over: it may go on behind
};

/// Both ends of a segment, by the beams beside it.
struct Ends {
  End low = End::kUnknown, high = End::kUnknown;  ///< at its first and last beam
  [[nodiscard]] bool seen() const { return low != End::kHidden && high != End::kHidden; }
};

/// A scan in pieces: its points, in the robot's frame and in the map, cut at its jumps.
struct ScanPieces {
  ScanPoints points;
  PointsInMap in_map;  ///< of as many points
  Segments segments;
  Sweep sweep;

  /// From the segment's first point to its last, m.
  [[nodiscard]] double width_m(const Segment& segment) const {
    return distance(in_map.position[segment.first], in_map.position[segment.last]);
  }
};

/// Returns the ends of a segment. A sweep's own end hides.
[[nodiscard]] Ends ends_of(const Segment& segment, const ScanPoints& points, const Sweep& sweep) noexcept;

/// A segment that is small enough for a body, and no part of a wall, or stands alone there: something may have come.
/// Filled in stages, each of which reads what those before it found: more fields than a struct has elsewhere.
struct Detection {
  Segment segment;
  BeamRun beams{};                       ///< that end on it, and those between
  Vec2 centre_in_map;                    ///< of the body: behind the visible arc
  double radius_m = 0.0;                 ///< of the disc that is seen as wide
  Vec2 mean_in_map;                      ///< of its points
  double mean_range_m = 0.0;             ///< of that, from the laser
  double low_rad = 0.0, high_rad = 0.0;  ///< from there to its sides, as the laser sees it
  double range_m = 0.0;                  ///< from the laser
  double spacing_m = 0.0;                ///< from beam to beam, across them
  double late_s = 0.0;                   ///< when they were measured, after the scan's stamp: their mean
  double late_std_s = 0.0;               ///< and standard deviation: half a sweep where they are its first and its last
  bool sparse = false;                   ///< two points, far off: a leg at most, and by itself nothing new
  Outline outline_in_map;
  Vec2 along;                                             ///< unit vector of the beams, away from the laser
  Vec2 high_side;                                         ///< unit vector across the beams, from the first to the last
  End low_end = End::kUnknown, high_end = End::kUnknown;  ///< at its first and last beam
  bool bulges = false;                                    ///< towards the laser, as round things do and no wall does
  bool behind_more = false;                               ///< what hides it is wider than legs
  bool in_free_space = false;                             ///< most of it stands where nothing stood before
  bool on_wall = false;                                   ///< most of it stands where walls stand
  std::uint32_t track_id = 0;                             ///< of the target that it was given to; 0: none

  [[nodiscard]] bool low_hidden() const { return low_end == End::kHidden; }
  [[nodiscard]] bool high_hidden() const { return high_end == End::kHidden; }
  [[nodiscard]] bool whole() const { return !low_hidden() && !high_hidden(); }
  /// -1 where its low side alone is hidden, 1 where its high one is; else 0.
  [[nodiscard]] int hidden_side() const { return (high_hidden() ? 1 : 0) - (low_hidden() ? 1 : 0); }
  /// Seen to end on both sides.
  [[nodiscard]] bool ends() const { return low_end == End::kSeen && high_end == End::kSeen; }
  /// As wide as a body, and seen to end on both sides, or round and nothing hides either.
  [[nodiscard]] bool stands_alone() const { return (ends() || (bulges && whole())) && as_wide_as_a_body(radius_m); }
  /// Leg-sized, or two legs side by side: two such may be one person.
  [[nodiscard]] bool leg() const { return radius_m < 0.15; }
  /// Too narrow for two of 0.1 m across.
  [[nodiscard]] bool one_leg() const { return radius_m < 0.09; }
};

/// Most detections followed in a scan, two legs of each of 64 people and as much besides; when full, later ones (in the
/// order of the beams) are not looked at.
inline constexpr std::size_t kMaxDetections = 256;
using Detections = FixedVector<Detection, kMaxDetections>;

/// The segments that are no walls and small enough for a body (at most 1.1 m across, or 1.6 m where they are seen to
/// end on both sides), of three points at least, or of two where beams are so far apart that a leg has no more, if
/// nothing nearer hides either side: walls at a slant are seen in such pieces. What stands where walls stand counts
/// only where it is as wide as a body and seen to end on both sides, or round: a pedestrian that stood there for long
/// may go on. In unknown space only those that stand out on one side at least count: what goes on behind something
/// nearer on both is a wall seen through a gap. What reaches the end of the sweep may go on outside it.
void find_detections(const ScanPieces& scan, Vec2 laser_in_map, Detections& out) noexcept;

/// Tells whether a scan shows exactly two obstacles as thin as legs within half a stride of a place in the map. Returns
/// nothing where the scan cannot tell: a leg is half hidden, the obstacle is as wide as a body, or beams lie too far
/// apart.
[[nodiscard]] std::optional<bool> two_legs_at(Vec2 place_in_map, const ScanPieces& scan) noexcept;

/// Obstacles that stand alone in the map and are no wider than bodies: people, chairs, posts. They go, as walls do not,
/// and one that went while nothing looked there stands in the map for good. Memory: a byte a cell, taken in the
/// constructor. Thread: the loop's.
class IsolatedObstacles {
 public:
  explicit IsolatedObstacles(const EvidenceMap& map);

  /// Where one of a scan's `count` points lies something is. `map`, here and below, is as large as the constructor's.
  void note_in_view(const EvidenceMap& map, const PointsInMap& in_map, std::size_t count) noexcept;
  /// Makes each of them unknown, as if it had never been seen, that is not in view; then nothing is in view any more.
  /// Looks at all cells: 1 to 2 ms for 1024 a side.
  void forget_unseen(EvidenceMap& map) noexcept;

 private:
  enum Mark : std::uint8_t { kNew, kInView, kGathered, kStays };

  [[nodiscard]] bool gather(const EvidenceMap& map, CellIndex first) noexcept;
  [[nodiscard]] bool take(const EvidenceMap& map, CellIndex cell) noexcept;

  std::vector<std::uint8_t> marks_;        ///< on the map's own torus
  FixedVector<CellIndex, 1024> gathered_;  ///< being gathered
};

}  // namespace jaywalk
