#include "planner/mapping/evidence_map.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {
/// Moves an offset an eighth of the way to `target`, or all the way where there was none yet.
std::int8_t moved_offset(std::int8_t old, double target, bool fresh) {
  const double next = fresh ? target : old + (target - old) / 8.0;
  return static_cast<std::int8_t>(std::clamp(std::floor(next + 0.5), -127.0, 127.0));
}

constexpr double kUnit = 127.0;        // a length of 1 in eight bits
constexpr double kLongestHitS = 0.25;  // one hit after a gap is one hit

}  // namespace

EvidenceMap::EvidenceMap(std::int32_t side_cells, double cell_m, Vec2 centre_in_map)
    : side_(side_cells),
      cell_m_(cell_m),
      evidence_(static_cast<std::size_t>(side_cells) * static_cast<std::size_t>(side_cells), 0),
      seen_for_(evidence_.size(), 0),
      surface_(evidence_.size()),
      to_laser_(evidence_.size()),
      changed_(evidence_.size() / kPiece) {
  const CellIndex centre = cell_at(centre_in_map);
  low_ = {centre.i - side_ / 2, centre.j - side_ / 2};
}

template <class T>
void EvidenceMap::copy_row_of(const std::vector<T>& values, CellIndex first, std::int32_t n, T* to) const noexcept {
  std::fill_n(to, n, T{});
  if (!within(first.j, low_.j)) return;
  const std::int32_t end = std::min(first.i + n, low_.i + side_);
  for (std::int32_t i = std::max(first.i, low_.i); i < end;) {  // a piece up to where the torus closes
    const std::size_t from = slot({i, first.j});
    const std::int32_t to_seam = side_ - static_cast<std::int32_t>(from % static_cast<std::size_t>(side_));
    const std::int32_t piece = std::min(end - i, to_seam);
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(from), piece, to + (i - first.i));
    i += piece;
  }
}

void EvidenceMap::copy_row(CellIndex first, std::int32_t n, std::int8_t* to) const noexcept {
  copy_row_of(evidence_, first, n, to);
}

void EvidenceMap::copy_row_of_surfaces(CellIndex first, std::int32_t n, Offset* to) const noexcept {
  copy_row_of(surface_, first, n, to);
}

void EvidenceMap::follow(const EvidenceMap& from) noexcept {
  if (followed_ != &from || changes_ > from.changes_ || side_ != from.side_) {
    *this = from;
    followed_ = &from;
    return;
  }
  for (std::size_t piece = 0; piece < changed_.size(); ++piece) {
    if (from.changed_[piece] <= changes_) continue;
    const auto begin = static_cast<std::ptrdiff_t>(piece * kPiece);
    std::copy_n(from.evidence_.begin() + begin, kPiece, evidence_.begin() + begin);
    std::copy_n(from.seen_for_.begin() + begin, kPiece, seen_for_.begin() + begin);
    std::copy_n(from.surface_.begin() + begin, kPiece, surface_.begin() + begin);
    std::copy_n(from.to_laser_.begin() + begin, kPiece, to_laser_.begin() + begin);
    changed_[piece] = from.changed_[piece];
  }
  low_ = from.low_;
  changes_ = from.changes_;
}

void EvidenceMap::add(CellIndex cell, int change) noexcept {
  if (!contains(cell)) return;
  const std::size_t k = slot(cell);
  const auto now = static_cast<std::int8_t>(std::clamp(evidence_[k] + change, kMin, kMax));
  const std::uint8_t seen_for = now <= 0 ? std::uint8_t{0} : seen_for_[k];
  if (now == evidence_[k] && seen_for == seen_for_[k]) return;
  evidence_[k] = now;
  seen_for_[k] = seen_for;
  note_change(k);
}

void EvidenceMap::add_hit(Vec2 p, int change, double seen_for_s, Vec2 to_laser) noexcept {
  const CellIndex cell = cell_at(p);
  if (!contains(cell)) return;
  const std::size_t k = slot(cell);
  const bool fresh = evidence_[k] <= 0 || to_laser_[k].x == kToldOnly;
  const Vec2 offset = (p - centre_of(cell)) * (128.0 / (0.5 * cell_m_));
  // What is certain stays where it was first seen: a wall that followed every scan would drift along with the pose.
  if (evidence_[k] < kMax)
    surface_[k] = {moved_offset(surface_[k].x, offset.x, fresh), moved_offset(surface_[k].y, offset.y, fresh)};
  const Vec2 towards = to_laser * kUnit;
  to_laser_[k] = {moved_offset(to_laser_[k].x, towards.x, fresh), moved_offset(to_laser_[k].y, towards.y, fresh)};
  add(cell, change);
  const int units =
      seen_for_[k] + static_cast<int>(std::floor(kSeenUnitsPerS * std::min(seen_for_s, kLongestHitS) + 0.5));
  seen_for_[k] = static_cast<std::uint8_t>(std::min(units, 255));
  note_change(k);
}

void EvidenceMap::tell(CellIndex cell, int evidence, Vec2 surface, Vec2 free_side) noexcept {
  if (!contains(cell)) return;
  const std::size_t k = slot(cell);
  const Vec2 offset = (surface - centre_of(cell)) * (128.0 / (0.5 * cell_m_));
  evidence_[k] = static_cast<std::int8_t>(std::clamp(evidence, kMin, kMax));
  seen_for_[k] = evidence > 0 ? static_cast<std::uint8_t>(kSeenUnitsPerS * kStandsAfterS) : std::uint8_t{0};
  surface_[k] = {moved_offset(0, offset.x, true), moved_offset(0, offset.y, true)};
  const auto sign = [](double v) { return v > 0.0 ? 1 : v < 0.0 ? -1 : 0; };
  to_laser_[k] = {kToldOnly, static_cast<std::int8_t>(3 * sign(free_side.x) + sign(free_side.y))};
  note_change(k);
}

Vec2 EvidenceMap::surface(CellIndex cell) const {
  const Offset& offset = surface_[slot(cell)];
  return centre_of(cell) + Vec2{offset.x * 1.0, offset.y * 1.0} * (0.5 * cell_m_ / 128.0);
}

Vec2 EvidenceMap::to_laser(CellIndex cell) const {
  const Offset& towards = to_laser_[slot(cell)];
  if (towards.x == kToldOnly) {
    const int x = towards.y > 1 ? 1 : towards.y < -1 ? -1 : 0;
    const Vec2 side{x * 1.0, (towards.y - 3 * x) * 1.0};
    return side * (1.0 / std::max(1.0, norm(side)));
  }
  return {towards.x / kUnit, towards.y / kUnit};
}

void EvidenceMap::forget(CellIndex cell) noexcept {
  if (!contains(cell)) return;
  const std::size_t k = slot(cell);
  evidence_[k] = 0;
  seen_for_[k] = 0;
  surface_[k] = {};
  to_laser_[k] = {};
  note_change(k);
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
