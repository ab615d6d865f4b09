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
  const float* psi;
  std::uint8_t* index;

  JAYWALK_CELL void operator()(std::int32_t i, std::int32_t j) const {
    const std::int32_t c = grid.at(i, j);
    Lowest lowest{psi[c], kHere};
    if (cell::is_joined(psi[c])) {
      const float east = psi_at(grid, psi, i + 1, j), west = psi_at(grid, psi, i - 1, j);
      const float north = psi_at(grid, psi, i, j + 1), south = psi_at(grid, psi, i, j - 1);
      lowest.look(east, 0), lowest.look(west, 1), lowest.look(north, 2), lowest.look(south, 3);
      const bool open_east = cell::is_joined(east), open_west = cell::is_joined(west);
      if (cell::is_joined(north)) {
        if (open_east) lowest.look(psi[c + grid.side + 1], 4);
        if (open_west) lowest.look(psi[c + grid.side - 1], 5);
      }
      if (cell::is_joined(south)) {
        if (open_east) lowest.look(psi[c - grid.side + 1], 6);
        if (open_west) lowest.look(psi[c - grid.side - 1], 7);
      }
    }
    index[c] = lowest.step;
  }

 private:
  struct Lowest {
    float psi;
    std::uint8_t step;
    JAYWALK_CELL void look(float there, std::uint8_t k) {
      if (there < psi) psi = there, step = k;  // false for what is not free
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
