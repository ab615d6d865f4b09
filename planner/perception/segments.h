#pragma once
// A scan cut where it jumps, and those pieces of it that stand where nothing stood before.
#include <array>
#include <cstdint>

#include "hal/types/fixed_vector.h"
#include "planner/grid/evidence_map.h"
#include "planner/perception/scan_points.h"

namespace jaywalk {

/// A run of neighbouring points that are one thing: points [first, last] of the scan.
struct Segment {
  std::uint32_t first = 0, last = 0;
};

/// Some of the points that something was seen by, spread over its width.
using Outline = FixedVector<Vec2, 5>;

/// Most segments kept of a scan; when full, the rest of the scan counts as wall.
inline constexpr std::size_t kMaxSegments = 512;
using Segments = FixedVector<Segment, kMaxSegments>;

/// What the beam beside a cluster says of that end of it.
enum class End : std::uint8_t {
  kUnknown,  ///< it returned nothing: what is seen at a slant may go on unseen
  kSeen,     ///< it goes on beyond
  kHidden,   ///< it ends on something nearer, or the sweep is over: the cluster may go on behind
};

/// A segment with no wall behind it that is small enough for a body: something may have come there.
struct Cluster {
  Segment segment;
  BeamRun beams{};         ///< that end on it, and those between
  Vec2 centre_in_map;      ///< of the body: behind the visible arc
  double radius_m = 0.0;   ///< half of the visible width
  double range_m = 0.0;    ///< from the laser
  double spacing_m = 0.0;  ///< from beam to beam, across them
  Outline outline_in_map;
  Vec2 along;                                             ///< unit vector of the beams, away from the laser
  Vec2 high_side;                                         ///< unit vector across the beams, from the first to the last
  End low_end = End::kUnknown, high_end = End::kUnknown;  ///< at its first and last beam
  bool behind_more = false;                               ///< what hides it is wider than legs
  bool in_free_space = false;                             ///< most of it stands where nothing stood before
  std::uint32_t track_id = 0;                             ///< of the body that it was given to; 0: none

  [[nodiscard]] bool low_hidden() const { return low_end == End::kHidden; }
  [[nodiscard]] bool high_hidden() const { return high_end == End::kHidden; }
  [[nodiscard]] bool whole() const { return !low_hidden() && !high_hidden(); }
  /// Seen on one side of something wider than legs, and to end on the other.
  [[nodiscard]] bool emerges() const {
    return behind_more && low_hidden() != high_hidden() && (low_end == End::kSeen || high_end == End::kSeen);
  }
  /// Leg-sized: two such may be one person.
  [[nodiscard]] bool leg() const { return radius_m < 0.15; }
};

/// The mean of the half circle that parallel beams see lies pi/4 of the radius before its centre.
inline constexpr double kArcMean = kPi / 4.0;

/// Most clusters followed in a scan; when full, later ones (in the order of the beams) are left for the next scans.
inline constexpr std::size_t kMaxClusters = 128;
using Clusters = FixedVector<Cluster, kMaxClusters>;

/// What the map says of the place where a point lies.
enum class Ground : std::uint8_t {
  kWall,     ///< a surface that has stood there is as near as noise and pose explain
  kUnknown,  ///< nothing, or a surface that came only now: a wall in view for the first time, or somebody
  kFree,     ///< beams passed there, three or more in a row (EvidenceMap::seen_free)
};

/// The scan's points in the map, and the ground that each stands on.
struct PointsInMap {
  std::array<Vec2, kMaxBeams> position;
  std::array<Ground, kMaxBeams> ground;
};

/// Cuts the scan where neighbouring points are farther apart than a surface explains (adaptive in range).
void cut_at_jumps(const ScanPoints& points, double angle_step_rad, Segments& out) noexcept;

/// The ground under a point that was seen from `range_m` away. A wall's points scatter by noise and by errors of the
/// pose: 0.10 m, and 0.012 m more a metre of range, about the surface that the map remembers are still its own.
[[nodiscard]] Ground ground_at(const EvidenceMap& still, Vec2 p_in_map, double range_m) noexcept;

/// The segments that are no walls and small enough for a body (at most 1.1 m across). In unknown space only those that
/// stand out on one side at least count: what goes on behind something nearer on both is a wall seen through a gap.
/// `last_beam` of the scan: what reaches there, or to beam 0, may go on outside the sweep.
void find_clusters(const ScanPoints& points, const PointsInMap& in_map, const Segments& segments,
                   std::uint32_t last_beam, Vec2 laser_in_map, Clusters& out) noexcept;

}  // namespace jaywalk
