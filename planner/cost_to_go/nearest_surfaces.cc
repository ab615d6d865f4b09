#include "planner/cost_to_go/nearest_surfaces.h"

#include <cstdlib>
#include <cstring>

#include "planner/cell/cell.h"

namespace jaywalk::field {
namespace {

constexpr std::int16_t kNoRow = 0x7fff;
constexpr std::int32_t kReach = 20;  ///< cells that a surface is known to: Guide::kFar_m

std::int32_t size_of(std::int16_t row) { return std::abs(static_cast<std::int32_t>(row)); }

}  // namespace

NearestSurfaces::NearestSurfaces(std::int32_t max_side)
    : own_(static_cast<std::size_t>(Grid{max_side}.cells())),
      own_offset_(own_.size()),
      has_own_(own_.size()),
      walls_(own_.size()),
      rows_(own_.size()),
      last_walls_(own_.size()),
      last_rows_(own_.size()),
      surface_(own_.size(), kNowhere),
      is_new_(static_cast<std::size_t>(max_side)),
      column_(static_cast<std::size_t>(max_side)),
      begin_(column_.size()),
      evidence_(column_.size()),
      offset_(column_.size()) {
  moved_.resize(own_.size());  // touched, not only reserved: no page is to be fetched later
  moved_.clear();
}

void NearestSurfaces::find(const Window& window, const CellBox& box, const EvidenceMap* still,
                           std::span<const MoverDisc> movers, std::uint8_t* unseen) noexcept {
  const Grid grid = window.grid();
  const auto cells = static_cast<std::size_t>(grid.cells()), side = static_cast<std::size_t>(grid.side);
  const bool anew = window != window_ || box != box_;
  if (window != window_) std::fill_n(has_own_.begin(), cells, std::uint8_t{0});
  window_ = window, box_ = box;
  walls_.swap(last_walls_);
  moved_.clear();
  fetch(still, unseen);
  for (const MoverDisc& mover : movers) {
    for_each_in_disc(window, box, mover.centre_in_map, mover.radius_m + kOwnBody_m,
                     [this](std::int32_t c) { walls_[static_cast<std::size_t>(c)] = 0; });
  }
  std::fill_n(is_new_.begin(), side, anew ? std::uint8_t{1} : std::uint8_t{0});
  if (anew) std::fill_n(surface_.begin(), cells, kNowhere);
  if (anew || std::memcmp(walls_.data(), last_walls_.data(), cells) != 0) {
    rows_.swap(last_rows_);
    spread_along_columns();
    for (std::size_t j = 0; j < side; ++j) {
      if (std::memcmp(&rows_[j * side], &last_rows_[j * side], side * sizeof(std::int16_t)) != 0) is_new_[j] = 1;
    }
  }
  for (const std::int32_t c : moved_) mark_rows_that_see(c % grid.side, c / grid.side);
  for (std::int32_t j = box.j0; j <= box.j1; ++j) {
    if (is_new(j)) spread_along_row(j);
  }
}

void NearestSurfaces::fetch(const EvidenceMap* still, std::uint8_t* unseen) noexcept {
  const std::int32_t width = box_.i1 - box_.i0 + 1;
  const auto count = static_cast<std::size_t>(width);
  std::fill_n(walls_.begin(), window_.grid().cells(), std::uint8_t{0});
  if (still == nullptr) return;
  for (std::int32_t j = box_.j0; j <= box_.j1; ++j) {
    const CellIndex first{window_.low.i + box_.i0, window_.low.j + j};
    still->copy_row(first, width, evidence_.data());
    still->copy_row_of_surfaces(first, width, offset_.data());
    const std::size_t c = at(box_.i0, j);
    std::uint8_t any_moved = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint8_t wall = evidence_[k] > EvidenceMap::kOccupied ? 1 : 0;
      const bool knows = has_own_[c + k] != 0 && offset_[k] == own_offset_[c + k];
      walls_[c + k] = wall;
      unseen[c + k] = evidence_[k] == 0 ? 1 : 0;
      any_moved = static_cast<std::uint8_t>(any_moved | (knows ? 0 : wall));
    }
    for (std::size_t k = 0; any_moved != 0 && k < count; ++k) {
      if (walls_[c + k] == 0 || (has_own_[c + k] != 0 && offset_[k] == own_offset_[c + k])) continue;
      own_[c + k] = place_of(still->surface({first.i + static_cast<std::int32_t>(k), first.j}));
      own_offset_[c + k] = offset_[k];
      has_own_[c + k] = 1;
      moved_.push_back(static_cast<std::int32_t>(c + k));
    }
  }
}

void NearestSurfaces::mark_rows_that_see(std::int32_t i, std::int32_t j) noexcept {
  for (std::int32_t row = std::max(j - kReach, box_.j0); row <= std::min(j + kReach, box_.j1); ++row) {
    const std::int16_t away = rows_[at(i, row)];
    if (away != kNoRow && row + away == j) is_new_[static_cast<std::size_t>(row)] = 1;
  }
}

/// How many rows up or down the nearest occupied cell of the same column is.
void NearestSurfaces::spread_along_columns() noexcept {
  for (std::size_t c = 0; c < static_cast<std::size_t>(window_.grid().cells()); ++c) {
    rows_[c] = walls_[c] != 0 ? std::int16_t{0} : kNoRow;
  }
  for (std::int32_t j = box_.j0 + 1; j <= box_.j1; ++j) {
    for (std::int32_t i = box_.i0; i <= box_.i1; ++i) {
      const std::int16_t below = rows_[at(i, j - 1)];
      if (rows_[at(i, j)] == 0 || below == kNoRow || below <= -kReach) continue;
      rows_[at(i, j)] = static_cast<std::int16_t>(below - 1);
    }
  }
  for (std::int32_t j = box_.j1 - 1; j >= box_.j0; --j) {
    for (std::int32_t i = box_.i0; i <= box_.i1; ++i) {
      const std::int16_t above = rows_[at(i, j + 1)], here = rows_[at(i, j)];
      if (above == kNoRow || above < 0 || above >= kReach || size_of(here) <= above + 1) continue;
      rows_[at(i, j)] = static_cast<std::int16_t>(above + 1);
    }
  }
}

/// By the lower envelope of the columns' parabolas (planner/cell/cell.h): what a cell keeps is the surface of the
/// column that is nearest to it.
void NearestSurfaces::spread_along_row(std::int32_t j) noexcept {
  const auto away = [&](std::int32_t i) { return rows_[at(i, j)] == kNoRow ? -1 : size_of(rows_[at(i, j)]); };
  std::fill(&surface_[at(box_.i0, j)], &surface_[at(box_.i1, j)] + 1, kNowhere);
  auto count = static_cast<std::size_t>(cell::lower_envelope(box_.i0, box_.i1, away, column_.data(), begin_.data()));
  for (std::int32_t i = box_.i1; i >= box_.i0 && count > 0; --i) {
    const std::int32_t u = column_[count - 1];
    if (std::abs(u - i) <= kReach) surface_[at(i, j)] = own_[at(u, j + rows_[at(u, j)])];
    if (i == begin_[count - 1]) --count;
  }
}

}  // namespace jaywalk::field
