#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "planner/field/window.h"
#include "planner/guide.h"
#include "planner/planner.h"

namespace jaywalk::field {

/// Cells of a window that the work is limited to, both ends included.
struct CellBox {
  std::int32_t i0 = 0, j0 = 0, i1 = 0, j1 = 0;
};

inline constexpr Place kNowhere{1e9F, 1e9F};

[[nodiscard]] inline Place place_of(Vec2 p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }

/// Calls visit(c, i, j) for the cells inside `box` whose middle lies within a disc.
template <class Visit>
void for_each_in_disc(const Window& window, const CellBox& box, Vec2 centre, double radius_m, const Visit& visit) {
  const Vec2 half{radius_m, radius_m};
  const CellIndex low = window.cell_at(centre - half), high = window.cell_at(centre + half);
  for (std::int32_t j = std::max(low.j, box.j0); j <= std::min(high.j, box.j1); ++j) {
    for (std::int32_t i = std::max(low.i, box.i0); i <= std::min(high.i, box.i1); ++i) {
      if (distance(window.in_map({i + 0.5, j + 0.5}), centre) <= radius_m) visit(window.grid().at(i, j));
    }
  }
}

/// The nearest surface to every cell of a window, where the laser's points say that it lies: finer than a cell.
/// Memory for windows of up to `max_side` cells in the constructor. Thread: the planner's.
class NearestSurfaces {
 public:
  explicit NearestSurfaces(std::int32_t max_side);

  /// For the cells inside `box`: `surface`, unchanged where none is within Guide::kFar_m or so, and whether nothing was
  /// ever seen in it. What lies within a mover's body is no surface, though the map may hold one there.
  void find(const Window& window, const CellBox& box, const EvidenceMap* still, std::span<const MoverDisc> movers,
            std::uint8_t* unseen, Place* surface) noexcept;

 private:
  void fetch(const Window& window, const CellBox& box, const EvidenceMap* still, std::uint8_t* unseen) noexcept;
  void spread_along_columns(Grid grid, const CellBox& box) noexcept;
  void spread_along_row(Grid grid, const CellBox& box, std::int32_t j, Place* surface) noexcept;

  std::vector<Place> own_;                    ///< each occupied cell's own surface
  std::vector<std::int16_t> rows_;            ///< to the nearest occupied cell in the column, signed; kNoRow: none near
  std::vector<std::int32_t> column_, begin_;  ///< of a row's envelope
};

}  // namespace jaywalk::field
