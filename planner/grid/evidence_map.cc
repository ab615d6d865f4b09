#include "planner/grid/evidence_map.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

/// Moves an offset an eighth of the way to `target`, or all the way where there was none yet.
std::int8_t moved_offset(std::int8_t old, double target, bool fresh) {
  const double next = fresh ? target : old + (target - old) / 8.0;
  return static_cast<std::int8_t>(std::clamp(std::floor(next + 0.5), -127.0, 127.0));
}

constexpr double kUnit = 127.0;         // a length of 1 in eight bits
constexpr double kLongestStepS = 0.25;  // one hit after a gap is one hit

}  // namespace

EvidenceMap::EvidenceMap(std::int32_t side_cells, double cell_m, Vec2 centre_in_map)
    : side_(side_cells),
      cell_m_(cell_m),
      evidence_(static_cast<std::size_t>(side_cells) * static_cast<std::size_t>(side_cells), 0),
      seen_for_(evidence_.size(), 0),
      surface_(evidence_.size()),
      to_laser_(evidence_.size()) {
  const CellIndex centre = cell_at(centre_in_map);
  low_ = {centre.i - side_ / 2, centre.j - side_ / 2};
}

Vec2 EvidenceMap::centre_of(CellIndex cell) const { return {(cell.i + 0.5) * cell_m_, (cell.j + 0.5) * cell_m_}; }

void EvidenceMap::add(CellIndex cell, int change) noexcept {
  if (!contains(cell)) return;
  const std::size_t k = slot(cell);
  std::int8_t& e = evidence_[k];
  e = static_cast<std::int8_t>(std::clamp(e + change, kMin, kMax));
  if (e <= 0) seen_for_[k] = 0;
}

void EvidenceMap::add_hit(Vec2 p, int change, double seen_for_s, Vec2 to_laser) noexcept {
  const CellIndex cell = cell_at(p);
  if (!contains(cell)) return;
  const std::size_t k = slot(cell);
  const bool fresh = evidence_[k] <= 0;
  const Vec2 offset = (p - centre_of(cell)) * (128.0 / (0.5 * cell_m_));
  // What is certain stays where it was first seen: a wall that followed every scan would drift along with the pose.
  if (evidence_[k] < kMax)
    surface_[k] = {moved_offset(surface_[k].x, offset.x, fresh), moved_offset(surface_[k].y, offset.y, fresh)};
  const Vec2 towards = to_laser * kUnit;
  to_laser_[k] = {moved_offset(to_laser_[k].x, towards.x, fresh), moved_offset(to_laser_[k].y, towards.y, fresh)};
  add(cell, change);
  const int units =
      seen_for_[k] + static_cast<int>(std::floor(kSeenUnitsPerS * std::min(seen_for_s, kLongestStepS) + 0.5));
  seen_for_[k] = static_cast<std::uint8_t>(std::min(units, 255));
}

Vec2 EvidenceMap::surface(CellIndex cell) const {
  const Offset& offset = surface_[slot(cell)];
  return centre_of(cell) + Vec2{offset.x * 1.0, offset.y * 1.0} * (0.5 * cell_m_ / 128.0);
}

Vec2 EvidenceMap::to_laser(CellIndex cell) const {
  const Offset& towards = to_laser_[slot(cell)];
  return {towards.x / kUnit, towards.y / kUnit};
}

void EvidenceMap::forget(CellIndex cell) noexcept {
  if (!contains(cell)) return;
  const std::size_t k = slot(cell);
  evidence_[k] = 0;
  seen_for_[k] = 0;
  surface_[k] = {};
  to_laser_[k] = {};
}

void EvidenceMap::roll_to(Vec2 centre_in_map) noexcept {
  const CellIndex centre = cell_at(centre_in_map);
  const CellIndex off{centre.i - (low_.i + side_ / 2), centre.j - (low_.j + side_ / 2)};
  if (std::abs(off.i) <= side_ / 4 && std::abs(off.j) <= side_ / 4) return;
  const CellIndex old = low_;
  low_ = {centre.i - side_ / 2, centre.j - side_ / 2};
  for (std::int32_t j = low_.j; j < low_.j + side_; ++j) {
    const bool row_stays = j >= old.j && j < old.j + side_;
    for (std::int32_t i = low_.i; i < low_.i + side_; ++i) {
      if (row_stays && i >= old.i && i < old.i + side_) continue;
      forget({i, j});
    }
  }
}

}  // namespace jaywalk
