#pragma once
// The potential of a map alone: no robot, no movers, any shape of map.
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "planner/mapping/window.h"
#include "planner/paper/executor.h"

namespace jaywalk::paper {

/// The harmonic potential to the last digit, which the solver is measured against; slow, not for the loop: psi = -ln u
/// of every cell that `goal` can be reached from through `free` cells (by rows, non-zero: free); infinity elsewhere. u
/// is 1 at the goal, the mean of its four neighbours in free cells, and 0 in all others and outside. Cells are
/// eliminated from the farthest to the nearest as an electrical network's nodes are (star to mesh): sums, products and
/// quotients of positive numbers only, so that every cell is right to about 1e-12 however small u is. Empty where it
/// would take more than `most` multiplications; a billion is about a second.
[[nodiscard]] std::vector<double> exact_psi(Grid grid, const std::uint8_t* free, std::int32_t goal,
                                            double most = std::numeric_limits<double>::infinity());

/// Share of cells with a finite `exact`, the goal apart, whose lowest 4-neighbour by `psi` is the lowest by `exact`.
/// One that `exact` puts within 1e-6 of its lowest counts too: a symmetric map has ties. 1 where there are none.
[[nodiscard]] double share_of_best(Grid grid, const float* psi, const std::vector<double>& exact, std::int32_t goal);

/// A map in cells, row by row from the lowest y; 1: wall. What lies outside is not free and does not inflate.
struct CellMap {
  std::int32_t width = 0, height = 0;
  std::vector<std::uint8_t> wall;
};

/// Largest side of a map that a MapField takes.
inline constexpr std::int32_t kMostMapCells = 2048;

/// Quality of a potential.
struct FieldQuality {
  bool done = false;        ///< the executor has not failed
  bool certified = false;   ///< every cell that the goal can be reached from has a strictly lower 4-neighbour
  std::int32_t pits = 0;    ///< joined cells without a lower neighbour
  std::int32_t joined = 0;  ///< cells that the goal can be reached from; 0: not from the robot's place
  std::int32_t cycles = 0;
};

/// The exact field is worth about four seconds (MapField::best_neighbours); that of 256 x 256 cells takes less.
inline constexpr double kMostMultiplications = 4e9;

/// Solves the potential of a map by the planner's own stages, on one executor (MapFieldOn). Takes its memory when
/// made, for the square of a power of two that holds the map. Not for the loop.
class MapField {
 public:
  MapField() = default;
  virtual ~MapField() = default;
  MapField(const MapField&) = delete;
  MapField& operator=(const MapField&) = delete;

  /// Grows walls by `inflation` cells (0 or more); what is free afterwards can be a goal.
  virtual void inflate(float inflation) noexcept = 0;
  /// The free cell nearest (i, j) within `radius` cells; false without one.
  [[nodiscard]] virtual bool nearest_free(CellIndex& at, std::int32_t radius) const noexcept = 0;
  /// From the walls to the certified potential of a free goal cell, nothing known before.
  virtual FieldQuality solve_cold(CellIndex goal) noexcept = 0;
  /// The same from the last solution, as a tick does in which nothing has changed.
  virtual FieldQuality solve_warm(CellIndex goal) noexcept = 0;
  /// The start field in its place: shortest ways, no potential solved.
  virtual FieldQuality solve_start(CellIndex goal) noexcept = 0;
  /// Share of joined cells from which descent arrives, counted cell by cell.
  [[nodiscard]] virtual float reach(CellIndex goal) noexcept = 0;
  /// Share of joined cells that pick the exact field's best neighbour (exact_psi); none when that would take more
  /// than `most` multiplications.
  [[nodiscard]] virtual std::optional<double> best_neighbours(CellIndex goal, double most) const = 0;
  /// -ln(1 - phi) of a cell of the map: NaN where not free, infinity where the goal cannot be reached.
  [[nodiscard]] virtual float psi(std::int32_t i, std::int32_t j) const noexcept = 0;
  [[nodiscard]] virtual const char* backend() const noexcept = 0;
  /// What a device has taken for all of this, by its own clock, without submission and waiting; 0 on the CPU.
  [[nodiscard]] virtual double device_ms() const noexcept = 0;
};

[[nodiscard]] std::unique_ptr<MapField> make_cpu_map_field(CellMap map);

}  // namespace jaywalk::paper
