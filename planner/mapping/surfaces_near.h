#pragma once
#include "planner/mapping/evidence_map.h"

namespace jaywalk {

/// Calls `visit` with places (in the map) all along what stands within `reach_m` of a place, each axis: every surface
/// of a cell that `counts`, and between those of cells that touch, so that none are farther than 4 cm apart.
template <class Counts, class Visit>
void for_each_surface_near(const EvidenceMap& still, Vec2 place, double reach_m, Counts&& counts, Visit&& visit) {
  constexpr int kPieces = 4;
  const Vec2 reach{reach_m, reach_m};
  const CellIndex first = still.cell_at(place - reach), last = still.cell_at(place + reach);
  for (std::int32_t j = first.j; j <= last.j; ++j) {
    for (std::int32_t i = first.i; i <= last.i; ++i) {
      if (!counts(CellIndex{i, j})) continue;
      const Vec2 here = still.surface({i, j});
      visit(here);
      for (const CellIndex beside : {CellIndex{i + 1, j}, {i, j + 1}, {i + 1, j + 1}, {i - 1, j + 1}}) {
        if (!counts(beside)) continue;
        const Vec2 piece = (still.surface(beside) - here) * (1.0 / kPieces);
        for (int k = 1; k < kPieces; ++k) visit(here + piece * k);
      }
    }
  }
}

}  // namespace jaywalk
