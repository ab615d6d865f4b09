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

Vec2 EvidenceMap::to_laser(CellIndex cell) const {
  const Offset& towards = to_laser_[slot(cell)];
  if (towards.x == kToldOnly) {
    const int x = towards.y > 1 ? 1 : towards.y < -1 ? -1 : 0;
    const Vec2 side{x * 1.0, (towards.y - 3 * x) * 1.0};
    return side * (1.0 / std::max(1.0, norm(side)));
  }
  return {towards.x / kUnit, towards.y / kUnit};
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
