#pragma once
// The index matrix and the paper's fourth kernel, the rubber band.
#include "planner/cell/band.h"
#include "planner/field/grid.h"
#include "planner/field/potential_stages.h"

namespace jaywalk::field {

/// A step to one of the eight neighbours.
struct Step {
  std::int32_t di, dj;
};

/// Where an entry of the index matrix leads: 0-3 straight, 4-7 diagonal, kHere and above nowhere.
inline constexpr std::uint8_t kHere = 8;
JAYWALK_CELL Step step_of(std::uint8_t index) {
  const std::int32_t k = index & 3;
  const Step straight{k == 0 ? 1 : (k == 1 ? -1 : 0), k == 2 ? 1 : (k == 3 ? -1 : 0)};
  const Step diagonal{(k & 1) == 0 ? 1 : -1, (k & 2) == 0 ? 1 : -1};
  return index < 4 ? straight : (index < kHere ? diagonal : Step{0, 0});
}

/// Equation index-matrix with eight neighbours for its four: the neighbour with the lowest potential, a
/// diagonal one only between two free cells, so that no corner is cut. Four would do to arrive; with
/// eight the raw path has half the stairs, and less is left to the band.
struct IndexOfEachCell {
  Grid grid;
  const float* psi;  ///< may be read beyond the border (take_rows)
  std::uint8_t* index;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t c = grid.at(i, j), up = c + grid.side, down = c - grid.side;
    const BesideCell beside = beside_cell(grid, psi, i, j);
    const bool east = cell::is_joined(beside.east), west = cell::is_joined(beside.west);
    const bool north = cell::is_joined(beside.north), south = cell::is_joined(beside.south);
    Lowest lowest{psi[c], kHere};
    lowest.look(beside.east, east, 0), lowest.look(beside.west, west, 1);
    lowest.look(beside.north, north, 2), lowest.look(beside.south, south, 3);
    lowest.look(psi[up + 1], north & east, 4), lowest.look(psi[up - 1], north & west, 5);
    lowest.look(psi[down + 1], south & east, 6), lowest.look(psi[down - 1], south & west, 7);
    index[c] = static_cast<std::uint8_t>(lowest.step);
  }

 private:
  struct Lowest {
    float psi;
    std::int32_t step;
    /// Nothing is lower than what is not free: NaN compares false.
    JAYWALK_CELL void look(float there, bool open, std::int32_t k) {
      const bool lower = open & (there < psi);
      psi = lower ? there : psi;
      step = lower ? k : step;
    }
  };
};

/// One half of the band's points, every other one, moved by its neighbours' tension and by what is near. A
/// point stays where it is rather than leave free cells, itself or half-way to a neighbour.
/// Points in cells from the window's low corner.
struct PullBand {
  Grid grid;
  std::int32_t first;  ///< the first point that may move
  const float* clearance;
  float reach;  ///< cells of clearance below which things push
  cell::Point* points;

  JAYWALK_CELL void operator()(std::int32_t k) const {
    const std::int32_t p = first + 2 * k;
    const cell::Point before = points[p - 1], here = points[p], after = points[p + 1];
    const cell::Point force = cell::clearance_force(clearance_at(here), slope_at(here), reach);
    const cell::Point there = cell::dragged(here, cell::tension(before, here, after), force, kGive);
    const cell::Point half_back{0.5F * (before.x + there.x), 0.5F * (before.y + there.y)};
    const cell::Point half_on{0.5F * (there.x + after.x), 0.5F * (there.y + after.y)};
    if (clearance_at(there) > 0.0F && clearance_at(half_back) > 0.0F && clearance_at(half_on) > 0.0F) points[p] = there;
  }

 private:
  static constexpr float kGive = 0.8F;

  JAYWALK_CELL float clearance_of(std::int32_t i, std::int32_t j) const {
    return grid.holds(i, j) ? clearance[grid.at(i, j)] : 0.0F;
  }
  JAYWALK_CELL float clearance_at(cell::Point p) const {
    if (p.x < 0.0F || p.y < 0.0F) return 0.0F;
    return clearance_of(static_cast<std::int32_t>(p.x), static_cast<std::int32_t>(p.y));
  }
  JAYWALK_CELL cell::Point slope_at(cell::Point p) const {
    const auto i = static_cast<std::int32_t>(p.x), j = static_cast<std::int32_t>(p.y);
    return {0.5F * (clearance_of(i + 1, j) - clearance_of(i - 1, j)),
            0.5F * (clearance_of(i, j + 1) - clearance_of(i, j - 1))};
  }
};

}  // namespace jaywalk::field
