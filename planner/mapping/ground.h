#pragma once
// What the map knows of the ground that a scan's points stand on.
#include <array>
#include <cstdint>

#include "planner/mapping/evidence_map.h"
#include "planner/scan/scan_points.h"

namespace jaywalk {

/// What the map says of the place where a point lies.
enum class Ground : std::uint8_t {
  kWall,     ///< a surface that has stood there is as near as noise and pose explain
  kUnknown,  ///< nothing, or a surface that came only now: a wall in view for the first time, or a pedestrian
  kFree,     ///< beams passed there, three or more in a row (EvidenceMap::seen_free)
};

/// The scan's points in the map, and the ground that each stands on.
struct PointsInMap {
  std::array<Vec2, kMaxBeams> position;
  std::array<Ground, kMaxBeams> ground;
};

/// So far about where the map remembers a surface what is seen from `range_m` away is still it, m: points scatter by
/// noise and by errors of the pose.
[[nodiscard]] double wall_noise_m(double range_m) noexcept;

/// The ground under a point that was seen from `range_m` away.
[[nodiscard]] Ground ground_at(const EvidenceMap& still, Vec2 p_in_map, double range_m) noexcept;

}  // namespace jaywalk
