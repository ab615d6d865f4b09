#pragma once
// Entering a scan into the evidence map.
#include <array>
#include <cstdint>
#include <vector>

#include "planner/grid/evidence_map.h"
#include "planner/perception/scan_points.h"

namespace jaywalk {

/// Which of a scan's points may become walls.
using IsStill = std::array<bool, kMaxBeams>;

/// Enters scans: a beam's cells up to just before its end are free, the cell it ends in is occupied. Each cell changes
/// at most once a scan, and an end counts more than a passing beam. Memory: 2 bytes a cell, taken in the constructor.
class MapEntry {
 public:
  explicit MapEntry(const EvidenceMap& map);

  /// `points_in_map[k]` and `still[k]` belong to point k of `count`; points that are not still free the cells
  /// before them and add nothing where they end. `step_s`: since the scan before.
  void enter(EvidenceMap& map, Vec2 laser_in_map, const std::array<Vec2, kMaxBeams>& points_in_map,
             const IsStill& still, std::size_t count, double step_s = 0.0) noexcept;

 private:
  [[nodiscard]] bool first_visit(CellIndex cell) noexcept;
  void free_along(EvidenceMap& map, Vec2 from, Vec2 to) noexcept;

  std::int32_t side_;
  std::uint16_t scan_ = 0;
  std::vector<std::uint16_t> visited_in_;  ///< the scan that last touched the cell, on the map's own torus
};

}  // namespace jaywalk
