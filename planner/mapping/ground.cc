#include "planner/mapping/ground.h"

namespace jaywalk {
namespace {

constexpr double kWallNoiseM = 0.10;      // a wall's points scatter this far about where the map holds it
constexpr double kWallNoisePerM = 0.012;  // and this much more a metre of range: 0.7 degrees of heading

}  // namespace

double wall_noise_m(double range) noexcept { return kWallNoiseM + kWallNoisePerM * range; }

Ground ground_at(const EvidenceMap& still, Vec2 p, double range) noexcept {
  const CellIndex cell = still.cell_at(p);
  const double near = wall_noise_m(range);
  const std::int32_t reach = near > still.cell_m() ? 2 : 1;
  for (std::int32_t j = -reach; j <= reach; ++j) {
    for (std::int32_t i = -reach; i <= reach; ++i) {
      const CellIndex c{cell.i + i, cell.j + j};
      if (still.stands(c) && distance(still.surface(c), p) < near) return Ground::kWall;
    }
  }
  return still.seen_free(cell) ? Ground::kFree : Ground::kUnknown;
}

}  // namespace jaywalk
