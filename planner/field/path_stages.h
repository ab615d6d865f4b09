#pragma once
// The index matrix and the paper's fourth kernel, the rubber band.
#include <cmath>

#include "planner/cell/band.h"
#include "planner/field/potential_stages.h"
#include "planner/mapping/grid.h"

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

/// The band as it is drawn: a copy of the raw path, none of whose points has moved yet.
struct BeginBand {
  const cell::Point* raw;
  cell::Point* points;
  std::int32_t* moved;

  JAYWALK_CELL void operator()(std::int32_t k) const {
    points[k] = raw[k];
    moved[k] = -1;
  }
};

/// Every third of the band's points, moved by its neighbours' tension and by what is near: the whole way, half, or a
/// quarter of it, and else not at all. What a move keeps, whatever the force:
/// - Free cells: all cells of the box that two neighbouring points span are free, so the segment between is in free
/// cells.
///   The raw path begins so, since its diagonal steps lie between two free cells.
/// - No turning back: the sharpest turn, at the point and at its neighbours, is at most 45 degrees, or no sharper than
///   before.
/// The turns at the neighbours reach two points to either side: hence thirds, for the same bits in any order.
/// A point is left alone that did not move when it was looked at last, while nothing within two points has since.
/// Points in cells from the window's low corner.
struct PullBand {
  Grid grid;
  std::int32_t first, count;  ///< the first point that may move; points in all
  const float* clearance;
  float reach;              ///< cells of clearance below which things push
  std::int32_t begun, now;  ///< step in which this force began to act, and this one; every third step is one point's
  cell::Point* points;
  std::int32_t* moved;  ///< in which step each point did last

  JAYWALK_CELL void operator()(std::int32_t k) const {
    const std::int32_t p = first + 3 * k;
    if (rests(p)) return;
    const cell::Point here = points[p];
    const cell::Point force = cell::clearance_force(clearance_at(here), slope_at(here), reach);
    const cell::Point pull = cell::tension(points[p - 1], here, points[p + 1]);
    for (float give = kGive; give > 0.15F * kGive; give *= 0.5F) {
      const cell::Point there = cell::dragged(here, pull, force, give);
      if (!stays_free(p, there) || !stays_gentle(p, there)) continue;
      points[p] = there;
      if (there.x != here.x || there.y != here.y) moved[p] = now;
      return;
    }
  }

 private:
  static constexpr float kGive = 0.8F;

  JAYWALK_CELL bool rests(std::int32_t p) const {
    const std::int32_t last_look = now - 3;
    if (last_look < begun) return false;
    const std::int32_t from = p > 2 ? p - 2 : 0, to = p + 2 < count ? p + 2 : count - 1;
    bool any = false;
    for (std::int32_t q = from; q <= to; ++q) any |= moved[q] >= last_look;
    return !any;
  }

  JAYWALK_CELL float clearance_of(std::int32_t i, std::int32_t j) const {
    return grid.holds(i, j) ? clearance[grid.at(i, j)] : 0.0F;
  }
  JAYWALK_CELL float clearance_at(cell::Point p) const {
    return clearance_of(static_cast<std::int32_t>(p.x), static_cast<std::int32_t>(p.y));
  }
  JAYWALK_CELL bool stays_free(std::int32_t p, cell::Point there) const {
    return there.x >= 0.0F && there.y >= 0.0F && is_box_free(points[p - 1], there) && is_box_free(there, points[p + 1]);
  }
  JAYWALK_CELL bool is_box_free(cell::Point a, cell::Point b) const {
    const auto ai = static_cast<std::int32_t>(a.x), aj = static_cast<std::int32_t>(a.y);
    const auto bi = static_cast<std::int32_t>(b.x), bj = static_cast<std::int32_t>(b.y);
    for (std::int32_t j = aj < bj ? aj : bj; j <= (aj < bj ? bj : aj); ++j) {
      for (std::int32_t i = ai < bi ? ai : bi; i <= (ai < bi ? bi : ai); ++i) {
        if (!(clearance_of(i, j) > 0.0F)) return false;
      }
    }
    return true;
  }
  /// The sharpest turn's cosine at point p and beside it, were p `at`.
  JAYWALK_CELL float sharpest_with(std::int32_t p, cell::Point at) const {
    float cosine = cell::turn_cosine(points[p - 1], at, points[p + 1]);
    if (p >= 2) cosine = sharper(cosine, cell::turn_cosine(points[p - 2], points[p - 1], at));
    if (p + 2 < count) cosine = sharper(cosine, cell::turn_cosine(at, points[p + 1], points[p + 2]));
    return cosine;
  }
  JAYWALK_CELL bool stays_gentle(std::int32_t p, cell::Point there) const {
    const float cosine = sharpest_with(p, there);
    return cosine >= cell::kSharpest || cosine >= sharpest_with(p, points[p]);
  }
  /// NaN, where points coincide, comes first and stays: such a move is refused.
  JAYWALK_CELL static float sharper(float a, float b) { return b < a ? b : a; }
  JAYWALK_CELL cell::Point slope_at(cell::Point p) const {
    const auto i = static_cast<std::int32_t>(p.x), j = static_cast<std::int32_t>(p.y);
    return {0.5F * (clearance_of(i + 1, j) - clearance_of(i - 1, j)),
            0.5F * (clearance_of(i, j + 1) - clearance_of(i, j - 1))};
  }
};

/// Cells within `radius` of (i, j).
struct Disc {
  std::int32_t i, j, radius;

  /// The rows of a grid that it touches, none where the second is below the first.
  [[nodiscard]] JAYWALK_CELL std::int32_t first_row() const { return j > radius ? j - radius : 0; }
  [[nodiscard]] JAYWALK_CELL std::int32_t last_row(Grid grid) const {
    return j + radius < grid.side ? j + radius : grid.side - 1;
  }
};

/// How many cells of a disc are joined, a row at a time: visit k takes its k-th row.
struct JoinedOfDisc {
  Grid grid;
  Disc disc;
  const float* psi;
  Counted* joined;

  JAYWALK_CELL void operator()(std::int32_t k) const {
    const std::int32_t j = disc.first_row() + k, dj = j - disc.j;
    std::int32_t count = 0;
    for (std::int32_t i = disc.i - disc.radius; i <= disc.i + disc.radius; ++i) {
      const std::int32_t di = i - disc.i;
      if (grid.holds(i, j) && di * di + dj * dj <= disc.radius * disc.radius) {
        count += cell::is_joined(psi[grid.at(i, j)]) ? 1 : 0;
      }
    }
    joined[k] = {count, count};
  }
};

/// How long the way from each point to the next is, in cells.
struct LengthOfSegment {
  const cell::Point* points;
  double* segments;

  JAYWALK_CELL void operator()(std::int32_t k) const {
    const double x = static_cast<double>(points[k + 1].x) - static_cast<double>(points[k].x);
    const double y = static_cast<double>(points[k + 1].y) - static_cast<double>(points[k].y);
    segments[k] = std::sqrt(x * x + y * y);
  }
};

/// And all of them, from the first to the last: one visit, since the order tells in the last digits.
struct LengthOfBand {
  std::int32_t count;
  const double* segments;
  double* length;

  JAYWALK_CELL void operator()(std::int32_t) const {
    double sum = 0.0;
    for (std::int32_t k = 0; k < count; ++k) sum += segments[k];
    *length = sum;
  }
};

}  // namespace jaywalk::field
