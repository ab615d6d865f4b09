#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "planner/cost_to_go/guide.h"
#include "planner/cost_to_go/planner.h"
#include "planner/mapping/window.h"

namespace jaywalk::field {

/// Cells of a window that the work is limited to, both ends included.
struct CellBox {
  std::int32_t i0 = 0, j0 = 0, i1 = 0, j1 = 0;
  bool operator==(const CellBox&) const = default;
};

inline constexpr Place kNowhere{1e9F, 1e9F};

[[nodiscard]] inline Place place_of(Vec2 p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }

/// Calls visit(c) for the cells inside `box` whose middle lies within a disc.
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

/// The nearest surface to every cell of a window, where the laser's points say that it lies: finer than a cell. What
/// has not changed since the last time is kept: rows are done anew that see other surfaces, or the same ones elsewhere.
/// Memory for windows of up to `max_side` cells in the constructor. Thread: the planner's.
class NearestSurfaces {
 public:
  explicit NearestSurfaces(std::int32_t max_side);

  /// For the cells inside `box`: the nearest surface, kNowhere where none is within Guide::kFar_m or so, and `unseen`:
  /// 1 where nothing was ever seen. What lies within a mover's body is no surface, though the map may hold one there.
  void find(const Window& window, const CellBox& box, const EvidenceMap* still, std::span<const MoverDisc> movers,
            std::uint8_t* unseen) noexcept;

  /// By rows; kNowhere outside the box.
  [[nodiscard]] const Place* surface() const noexcept { return surface_.data(); }
  /// Whether the last find() did a row anew.
  [[nodiscard]] bool is_new(std::int32_t j) const noexcept { return is_new_[static_cast<std::size_t>(j)] != 0; }

 private:
  void fetch(const EvidenceMap* still, std::uint8_t* unseen) noexcept;
  void mark_rows_that_see(std::int32_t i, std::int32_t j) noexcept;
  void spread_along_columns() noexcept;
  void spread_along_row(std::int32_t j) noexcept;
  [[nodiscard]] std::size_t at(std::int32_t i, std::int32_t j) const noexcept {
    return static_cast<std::size_t>(window_.grid().at(i, j));
  }

  Window window_;  ///< of the last time
  CellBox box_;
  std::vector<Place> own_;                       ///< each occupied cell's own surface
  std::vector<EvidenceMap::Offset> own_offset_;  ///< where that lies in the cell
  std::vector<std::uint8_t> has_own_;            ///< 1: both are known
  std::vector<std::uint8_t> walls_;              ///< 1: occupied, and no mover's body
  std::vector<std::int16_t> rows_;               ///< to the nearest such cell in the column, signed; kNoRow: none near
  std::vector<std::uint8_t> last_walls_;
  std::vector<std::int16_t> last_rows_;
  std::vector<Place> surface_;
  std::vector<std::uint8_t> is_new_;          ///< by row
  std::vector<std::int32_t> moved_;           ///< cells whose own surface has moved
  std::vector<std::int32_t> column_, begin_;  ///< of a row's envelope
  std::vector<std::int8_t> evidence_;         ///< of a row, and where its surfaces lie
  std::vector<EvidenceMap::Offset> offset_;
};

}  // namespace jaywalk::field
