#pragma once
// Scan points against the evidence map: the ground under each, and their entry.
#include <array>
#include <cstdint>
#include <vector>

#include "hal/types/robot_model.h"
#include "planner/mapping/evidence_map.h"
#include "planner/scan/scan_points.h"

namespace jaywalk {
/// What the map says of the place where a point lies.
enum class Ground : std::uint8_t {
  kWall,     ///< a surface that has stood there is as near as noise and pose explain
  kUnknown,  ///< nothing, or a surface that came only now: a wall in view for the first time, or a pedestrian
  kFree,     ///< beams passed there, three or more in a row (EvidenceMap::seen_free)
};

struct PointsInMap {
  std::array<Vec2, kMaxBeams> position;
  std::array<Ground, kMaxBeams> ground;
};

/// Scatter of a surface's points about where the map has it, by noise and errors of the pose, seen from `range_m`, m.
[[nodiscard]] double wall_noise_m(double range_m) noexcept;

/// The ground under a point that was seen from `range_m` away.
[[nodiscard]] Ground ground_at(const EvidenceMap& still, Vec2 p_in_map, double range_m) noexcept;

/// What a scan's point may become in the map.
enum class Becomes : std::uint8_t {
  kNothing,   ///< something moves there: only the way to it is free
  kObstacle,  ///< and no wall yet, however long it is seen: a pedestrian may stand there (EvidenceMap::stands)
  kWall,      ///< an obstacle, and a wall in time
};
using Entries = std::array<Becomes, kMaxBeams>;

/// Where the robot's body is nothing else stands: cells that were never seen and whose middle lies under it are free.
void free_under(EvidenceMap& map, const Pose2& map_from_robot, const Footprint& body) noexcept;

/// Enters scans: a beam's cells up to just before its end are free, the cell it ends in is occupied. Each cell changes
/// at most once a scan, and an end counts more than a passing beam. Memory: 2 bytes a cell, taken in the constructor.
class MapEntry {
 public:
  explicit MapEntry(const EvidenceMap& map)
      : visited_in_(static_cast<std::size_t>(map.side()) * static_cast<std::size_t>(map.side()), 0) {}

  /// The first `count` of `points_in_map` and `entries`; all free the cells before them. `step_s`: since the last scan.
  void enter(EvidenceMap& map, Vec2 laser_in_map, const std::array<Vec2, kMaxBeams>& points_in_map,
             const Entries& entries, std::size_t count, double step_s = 0.0) noexcept;

  /// Marks the unknown cells along a beam without a return as observed, up to `to_in_map`. Such a cell is not free
  /// (EvidenceMap::seen_free), and an occupied cell stays occupied (docs/explanation/decisions/beams.md and 0075).
  static void mark_observed(EvidenceMap& map, Vec2 laser_in_map, Vec2 to_in_map) noexcept;

 private:
  [[nodiscard]] bool first_visit(std::size_t slot) noexcept { return std::exchange(visited_in_[slot], scan_) != scan_; }
  void free_along(EvidenceMap& map, Vec2 from, Vec2 to) noexcept;

  std::uint16_t scan_ = 0;
  std::vector<std::uint16_t> visited_in_;  ///< the scan that last touched the cell, on the map's own torus
};

}  // namespace jaywalk
