#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "planner/mapping/evidence_map.h"

namespace jaywalk {

enum class KnownCell : std::uint8_t { kUnknown, kFree, kWall };

/// A side of the largest: 500 m in cells of 10 cm.
inline constexpr std::int32_t kMostKnownCells = 5000;

/// A map from before the run, in the evidence map's cells.
struct KnownMap {
  double cell_m = 0.1;
  CellIndex low;  ///< of its lowest cell
  std::int32_t width = 0, height = 0;
  std::vector<KnownCell> cells;  ///< by rows from the lowest y

  [[nodiscard]] bool holds(CellIndex cell) const noexcept {
    return cell.i >= low.i && cell.j >= low.j && cell.i < low.i + width && cell.j < low.j + height;
  }
  /// A wall stays one: of a cell that holds part of a wall the rest is free.
  void mark(CellIndex cell, KnownCell as) noexcept {
    KnownCell& marked = cells[index(cell)];
    if (marked != KnownCell::kWall) marked = as;
  }
  /// Unknown outside.
  [[nodiscard]] KnownCell at(CellIndex cell) const noexcept {
    if (!holds(cell)) return KnownCell::kUnknown;
    return cells[index(cell)];
  }

  /// Of a cell that it holds.
  [[nodiscard]] std::size_t index(CellIndex cell) const noexcept {
    return static_cast<std::size_t>(cell.j - low.j) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(cell.i - low.i);
  }
};

/// Enters what `known` holds into a map where it is new: believed, until a few scans say otherwise. Walls count as seen
/// for long. What lies outside the map's window is left out, and what lay in it when its lowest cell was `before`.
void enter(const KnownMap& known, EvidenceMap& map, std::optional<CellIndex> before) noexcept;

}  // namespace jaywalk
