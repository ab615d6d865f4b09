#pragma once
// The potential of a map alone: no robot, no movers, any shape of map.
#include <cstdint>
#include <memory>
#include <vector>

#include "planner/field/window.h"

namespace jaywalk::field {

/// A map in cells, row by row from the lowest y; 1: wall. What lies outside is not free and does not inflate.
struct CellMap {
  std::int32_t width = 0, height = 0;
  std::vector<std::uint8_t> wall;
};

/// Largest side of a map that MapField takes.
inline constexpr std::int32_t kMostMapCells = 2048;

/// How a map's potential came out.
struct MapQuality {
  bool certified = false;  ///< every cell that the goal can be reached from has a strictly lower 4-neighbour
  float reach = 0.0F;      ///< share of those cells from which descent arrives
  std::int32_t joined = 0;
  std::int32_t cycles = 0;
};

/// Solves the potential of a map on the CPU, by the planner's own stages. Takes its memory in the constructor, for the
/// square of a power of two that holds the map. Not for the loop.
class MapField {
 public:
  explicit MapField(CellMap map);
  ~MapField();
  MapField(const MapField&) = delete;
  MapField& operator=(const MapField&) = delete;

  /// Grows walls by `inflation` cells (0 or more); what is free afterwards can be a goal.
  void inflate(float inflation) noexcept;
  /// The free cell nearest (i, j) within `radius` cells; false without one.
  [[nodiscard]] bool nearest_free(CellIndex& at, std::int32_t radius) const noexcept;
  /// From the walls to the certified potential of a free goal cell, nothing known before.
  MapQuality solve_cold(CellIndex goal) noexcept;
  /// The same from the last solution, as a tick does in which nothing has changed.
  MapQuality solve_warm(CellIndex goal) noexcept;
  /// Share of joined cells from which descent arrives, counted cell by cell.
  [[nodiscard]] float reach(CellIndex goal) noexcept;
  /// -ln(1 - phi) of a cell of the map: NaN where not free, infinity where the goal cannot be reached.
  [[nodiscard]] float psi(std::int32_t i, std::int32_t j) const noexcept;

 private:
  struct Solver;
  CellMap map_;
  float inflation_ = 0.0F;
  std::unique_ptr<Solver> solver_;
};

}  // namespace jaywalk::field
