#include "planner/field/nearest_surfaces.h"

#include <cstdlib>

#include "planner/cell/clearance.h"

namespace jaywalk::field {
namespace {

constexpr std::int16_t kNoRow = 0x7fff;
constexpr std::int32_t kReach = 20;  ///< cells that a surface is known to: Guide::kFar_m

std::int32_t size_of(std::int16_t row) { return std::abs(static_cast<std::int32_t>(row)); }

}  // namespace

NearestSurfaces::NearestSurfaces(std::int32_t max_side)
    : own_(static_cast<std::size_t>(Grid{max_side}.cells())),
      rows_(own_.size()),
      column_(static_cast<std::size_t>(max_side)),
      begin_(column_.size()) {}

void NearestSurfaces::find(const Window& window, const CellBox& box, const EvidenceMap* still,
                           std::span<const MoverDisc> movers, std::uint8_t* unseen, Place* surface) noexcept {
  fetch(window, box, still, unseen);
  for (const MoverDisc& mover : movers) {
    for_each_in_disc(window, box, mover.centre_in_map, mover.radius_m + kOwnBody_m,
                     [this](std::int32_t c) { rows_[static_cast<std::size_t>(c)] = kNoRow; });
  }
  spread_along_columns(window.grid(), box);
  for (std::int32_t j = box.j0; j <= box.j1; ++j) spread_along_row(window.grid(), box, j, surface);
}

void NearestSurfaces::fetch(const Window& window, const CellBox& box, const EvidenceMap* still,
                            std::uint8_t* unseen) noexcept {
  for (std::int32_t j = box.j0; j <= box.j1; ++j) {
    for (std::int32_t i = box.i0; i <= box.i1; ++i) {
      const auto c = static_cast<std::size_t>(window.grid().at(i, j));
      const CellIndex cell{window.low.i + i, window.low.j + j};
      const bool wall = still != nullptr && still->occupied(cell);
      rows_[c] = wall ? std::int16_t{0} : kNoRow;
      unseen[c] = still != nullptr && still->evidence(cell) == 0 ? std::uint8_t{1} : std::uint8_t{0};
      if (wall) own_[c] = place_of(still->surface(cell));
    }
  }
}

/// How many rows up or down the nearest occupied cell of the same column is.
void NearestSurfaces::spread_along_columns(Grid grid, const CellBox& box) noexcept {
  const auto at = [&grid](std::int32_t i, std::int32_t j) { return static_cast<std::size_t>(grid.at(i, j)); };
  for (std::int32_t j = box.j0 + 1; j <= box.j1; ++j) {
    for (std::int32_t i = box.i0; i <= box.i1; ++i) {
      const std::int16_t below = rows_[at(i, j - 1)];
      if (rows_[at(i, j)] == 0 || below == kNoRow || below <= -kReach) continue;
      rows_[at(i, j)] = static_cast<std::int16_t>(below - 1);
    }
  }
  for (std::int32_t j = box.j1 - 1; j >= box.j0; --j) {
    for (std::int32_t i = box.i0; i <= box.i1; ++i) {
      const std::int16_t above = rows_[at(i, j + 1)], here = rows_[at(i, j)];
      if (above == kNoRow || above < 0 || above >= kReach || size_of(here) <= above + 1) continue;
      rows_[at(i, j)] = static_cast<std::int16_t>(above + 1);
    }
  }
}

/// By the lower envelope of the columns' parabolas (planner/cell/clearance.h): what a cell keeps is the surface of the
/// column that is nearest to it.
void NearestSurfaces::spread_along_row(Grid grid, const CellBox& box, std::int32_t j, Place* surface) noexcept {
  const auto at = [&](std::int32_t i) { return static_cast<std::size_t>(grid.at(i, j)); };
  const auto height = [&](std::int32_t i) { return size_of(rows_[at(i)]); };
  std::size_t count = 0;
  for (std::int32_t u = box.i0; u <= box.i1; ++u) {
    if (rows_[at(u)] == kNoRow) continue;
    const auto loses = [&](std::size_t k) {
      return cell::squared_distance(begin_[k], column_[k], height(column_[k])) >
             cell::squared_distance(begin_[k], u, height(u));
    };
    while (count > 0 && loses(count - 1)) --count;
    std::int32_t from = box.i0;
    if (count > 0) {
      const std::int32_t before = column_[count - 1];
      from = 1 + cell::last_nearer(before, height(before), u, height(u));
    }
    if (from > box.i1) continue;
    column_[count] = u;
    begin_[count++] = from > box.i0 ? from : box.i0;
  }
  for (std::int32_t i = box.i1; i >= box.i0 && count > 0; --i) {
    const std::int32_t u = column_[count - 1];
    if (std::abs(u - i) <= kReach) surface[at(i)] = own_[static_cast<std::size_t>(grid.at(u, j + rows_[at(u)]))];
    if (i == begin_[count - 1]) --count;
  }
}

}  // namespace jaywalk::field
