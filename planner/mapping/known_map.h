#pragma once
// Knowledge from before the run: a map, and keep-out zones, where the body must not be though nothing stands there.
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/types/map_zones.h"
#include "planner/cell/cell.h"
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

/// View of a KeepOutField, in plain values, for planning alone. Empty (no nodes): the robot may be anywhere.
struct KeepOut {
  static constexpr float kFar_m = 2.0F;

  float low_x = 0.0F, low_y = 0.0F;    ///< the first node in the map, m
  float node_m = 0.1F;                 ///< between nodes
  std::int32_t width = 0, height = 0;  ///< nodes
  const float* distance_m = nullptr;   ///< by rows from the lowest y

  [[nodiscard]] JAYWALK_CELL bool known() const { return width > 0; }

  /// From a place to the nearest zone (m), its margin taken off: kFar_m at most, below 0 in one.
  [[nodiscard]] JAYWALK_CELL float distance(float x, float y) const {
    const float gx = (x - low_x) / node_m, gy = (y - low_y) / node_m;
    const auto last_x = static_cast<float>(width - 1), last_y = static_cast<float>(height - 1);
    if (!(gx >= 0.0F && gy >= 0.0F && gx < last_x && gy < last_y)) return kFar_m;
    const auto i = static_cast<std::int32_t>(gx), j = static_cast<std::int32_t>(gy);
    const float fx = gx - static_cast<float>(i), fy = gy - static_cast<float>(j);
    const float* d = distance_m + j * width + i;
    const float low = d[0] + fx * (d[1] - d[0]), high = d[width] + fx * (d[width + 1] - d[width]);
    return low + fy * (high - low);
  }
};

/// Distances to keep-out zones, each kZoneMargin_m wider than drawn, in nodes 0.1 m apart: computed once.
/// Memory: 4 bytes a node of the box about all zones and 2 m more. The constructor is for start-up.
class KeepOutField {
 public:
  explicit KeepOutField(std::span<const MapZone> zones);
  [[nodiscard]] KeepOut view() const noexcept;

 private:
  void add(const MapZone& zone);

  Vec2 low_;
  std::int32_t width_ = 0, height_ = 0;
  std::vector<float> distance_m_;
};

}  // namespace jaywalk
