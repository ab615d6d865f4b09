#pragma once
// Clearing of isolated obstacles: what the map remembers and no beam sees may have gone.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hal/types/fixed_vector.h"
#include "planner/mapping/evidence_map.h"
#include "planner/mapping/ground.h"

namespace jaywalk {

/// Obstacles that stand alone in the map and are no wider than bodies: people, chairs, posts. They go, as walls do not,
/// and one that went while nothing looked there stands in the map for good. Memory: a byte a cell, taken in the
/// constructor. Thread: the loop's.
class IsolatedObstacles {
 public:
  explicit IsolatedObstacles(const EvidenceMap& map);

  /// Nothing is in view. `map`, here and below, is as large as the constructor's.
  void begin() noexcept;
  /// Where one of a scan's `count` points lies something is.
  void note_in_view(const EvidenceMap& map, const PointsInMap& in_map, std::size_t count) noexcept;
  /// Makes each of them unknown, as if it had never been seen, that is not in view. Looks at all cells: 1 to 2 ms for
  /// 1024 a side.
  void forget_unseen(EvidenceMap& map) noexcept;

 private:
  enum Mark : std::uint8_t { kNew, kInView, kGathered, kStays };

  [[nodiscard]] bool gather(const EvidenceMap& map, CellIndex first) noexcept;
  [[nodiscard]] bool take(const EvidenceMap& map, CellIndex cell) noexcept;

  std::vector<std::uint8_t> marks_;        ///< on the map's own torus
  FixedVector<CellIndex, 1024> gathered_;  ///< being gathered
};

}  // namespace jaywalk
