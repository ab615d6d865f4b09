#include "planner/tracking/isolated_obstacles.h"

#include <algorithm>
#include <cstdlib>

#include "planner/tracking/detection.h"

namespace jaywalk {
namespace {

/// Calls `each` with the cell and the eight about it, until it says no; whether it never did.
template <class Each>
bool all_about(CellIndex cell, const Each& each) {
  for (std::int32_t j = cell.j - 1; j <= cell.j + 1; ++j) {
    for (std::int32_t i = cell.i - 1; i <= cell.i + 1; ++i) {
      if (!each(CellIndex{i, j})) return false;
    }
  }
  return true;
}

}  // namespace

IsolatedObstacles::IsolatedObstacles(const EvidenceMap& map)
    : marks_(static_cast<std::size_t>(map.side()) * static_cast<std::size_t>(map.side()), kNew) {}

/// By their noise points lie a cell beside what they are of.
void IsolatedObstacles::note_in_view(const EvidenceMap& map, const PointsInMap& in_map, std::size_t count) noexcept {
  for (std::size_t k = 0; k < count; ++k) {
    (void)all_about(map.cell_at(in_map.position[k]), [&](CellIndex cell) {
      if (map.contains(cell)) marks_[map.slot(cell)] = kInView;
      return true;
    });
  }
}

/// False where the cell is in view, of what stays, or farther from the first than bodies are wide.
bool IsolatedObstacles::take(const EvidenceMap& map, CellIndex cell) noexcept {
  std::uint8_t& mark = marks_[map.slot(cell)];
  if (mark == kGathered) return true;
  if (mark != kNew || !gathered_.push_back(cell)) return false;
  mark = kGathered;
  const std::int32_t off = std::max(std::abs(cell.i - gathered_[0].i), std::abs(cell.j - gathered_[0].j));
  return off * map.cell_m() < kWidestBodyM;
}

/// All that hangs together with `first`; false where that stays.
bool IsolatedObstacles::gather(const EvidenceMap& map, CellIndex first) noexcept {
  gathered_.clear();
  bool loose = take(map, first);
  for (std::size_t k = 0; loose && k < gathered_.size(); ++k) {
    loose = all_about(gathered_[k], [&](CellIndex cell) { return !map.occupied(cell) || take(map, cell); });
  }
  for (const CellIndex cell : gathered_) marks_[map.slot(cell)] = kStays;
  return loose;
}

void IsolatedObstacles::begin() noexcept { std::fill(marks_.begin(), marks_.end(), kNew); }

void IsolatedObstacles::forget_unseen(EvidenceMap& map) noexcept {
  const CellIndex low = map.low();
  for (std::int32_t j = low.j; j < low.j + map.side(); ++j) {
    for (std::int32_t i = low.i; i < low.i + map.side(); ++i) {
      if (!map.occupied({i, j}) || marks_[map.slot({i, j})] != kNew || !gather(map, {i, j})) continue;
      for (const CellIndex cell : gathered_) map.forget(cell);
    }
  }
}

}  // namespace jaywalk
