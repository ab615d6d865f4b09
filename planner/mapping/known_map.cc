#include "planner/mapping/known_map.h"

#include <algorithm>
#include <array>

namespace jaywalk {
namespace {

constexpr int kWall = 40, kFree = -40;  ///< below certain, both: a few scans change them
/// From a wall's middle to its side, in cells: a drawn wall's face; one that was mapped lies anywhere in its cell.
constexpr double kHalf = 0.5;

constexpr std::array<CellIndex, 4> kBeside{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

/// Towards the free cells beside it; 0 where they are on both sides, or none is.
Vec2 to_free_side(const KnownMap& known, CellIndex at) {
  Vec2 side;
  for (const CellIndex by : kBeside) {
    if (known.at({at.i + by.i, at.j + by.j}) == KnownCell::kFree) side = side + Vec2{1.0 * by.i, 1.0 * by.j};
  }
  return side;
}

/// A wall's inside, which no laser sees.
bool is_inside(const KnownMap& known, CellIndex at) {
  return std::all_of(kBeside.begin(), kBeside.end(), [&](CellIndex by) {
    const CellIndex cell{at.i + by.i, at.j + by.j};
    return !known.holds(cell) || known.at(cell) == KnownCell::kWall;
  });
}

}  // namespace

void enter(const KnownMap& known, EvidenceMap& map, std::optional<CellIndex> before) noexcept {
  const CellIndex low{std::max(known.low.i, map.low().i), std::max(known.low.j, map.low().j)};
  const CellIndex end{std::min(known.low.i + known.width, map.low().i + map.side()),
                      std::min(known.low.j + known.height, map.low().j + map.side())};
  const auto was_inside = [&](std::int32_t at, std::int32_t first) { return at >= first && at < first + map.side(); };
  for (std::int32_t j = low.j; j < end.j; ++j) {
    for (std::int32_t i = low.i; i < end.i; ++i) {
      if (before && was_inside(i, before->i) && was_inside(j, before->j)) continue;
      const KnownCell cell = known.at({i, j});
      const Vec2 middle = map.centre_of({i, j});
      if (cell == KnownCell::kFree) map.tell({i, j}, kFree, middle);
      if (cell != KnownCell::kWall || is_inside(known, {i, j})) continue;
      const Vec2 free_side = to_free_side(known, {i, j});
      map.tell({i, j}, kWall, middle + free_side * (kHalf * known.cell_m), free_side);
    }
  }
}

}  // namespace jaywalk
