#include "planner/mapping/map_entry.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace jaywalk {
namespace {
constexpr double kWallNoiseM = 0.10;      // a wall's points scatter this far about where the map holds it
constexpr double kWallNoisePerM = 0.012;  // and this much more a metre of range: 0.7 degrees of heading

// Two hits make an obstacle (20 > 16), three passing beams make free space (-18 < -16), and an obstacle held for
// certain (64) is given up after nine scans that look through it: 0.6 s at 15 Hz.
constexpr int kHit = 10;
constexpr int kPass = -6;
constexpr int kObserved = -1;  // the smallest evidence that is not unknown (0) and not free (below kFree)

constexpr double kNearestM = 1e-6;  // nothing is hit nearer: no division by 0

/// So near before its end a beam frees no cell that was hit: ranges scatter, and were a wall's near hits wiped out by
/// the beams of its far ones, the map would hold walls farther off than they are.
constexpr std::int32_t kNoiseCells = 2;

/// One axis of a walk through the cells that a line crosses (Amanatides and Woo 1987).
struct AxisWalk {
  std::int32_t step = 0;
  double next = std::numeric_limits<double>::infinity();  ///< share of the line at the next cell border
  double each = std::numeric_limits<double>::infinity();  ///< share of the line a cell

  AxisWalk(double from, double length, std::int32_t cell, double cell_m) {
    if (length == 0.0) return;
    step = length > 0.0 ? 1 : -1;
    each = cell_m / std::fabs(length);
    next = ((cell + (step > 0 ? 1 : 0)) * cell_m - from) / length;
  }
};

/// Calls `visit(cell, left)` for each cell that the line crosses but the last; `left`: cells to the line's end.
template <class Visit>
void for_each_crossed(const EvidenceMap& map, Vec2 from, Vec2 to, Visit visit) {
  CellIndex cell = map.cell_at(from);
  const CellIndex end = map.cell_at(to);
  AxisWalk x(from.x, to.x - from.x, cell.i, map.cell_m()), y(from.y, to.y - from.y, cell.j, map.cell_m());
  const std::int32_t cells = std::abs(end.i - cell.i) + std::abs(end.j - cell.j);
  for (std::int32_t k = 0; k < cells; ++k) {
    if (!map.contains(cell))
      return;  // a straight line does not come back: a beam of a kilometre costs no more than the map
    visit(cell, cells - k);
    if (x.next < y.next) {
      cell.i += x.step;
      x.next += x.each;
    } else {
      cell.j += y.step;
      y.next += y.each;
    }
  }
}

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

/// The cell that the beam ends in is left out: it ends just behind the last.
void MapEntry::free_along(EvidenceMap& map, Vec2 from, Vec2 to) noexcept {
  for_each_crossed(map, from, to, [&](CellIndex cell, std::int32_t left) {
    if (!(left <= kNoiseCells && map.evidence(cell) > 0) && first_visit(map.slot(cell))) map.add(cell, kPass);
  });
}

void MapEntry::mark_observed(EvidenceMap& map, Vec2 laser, Vec2 to) noexcept {
  for_each_crossed(map, laser, to, [&](CellIndex cell, std::int32_t) {
    if (map.evidence(cell) == 0) map.add(cell, kObserved);
  });
}

void free_under(EvidenceMap& map, const Pose2& map_from_robot, const Footprint& body) noexcept {
  if (body.half_width_m <= 0.0) return;
  const double reach = body.circumscribed_radius_m();
  const Vec2 middle = map_from_robot.position();
  const Pose2 robot_from_map = inverse(map_from_robot);
  const CellIndex low = map.cell_at(middle - Vec2{reach, reach}), high = map.cell_at(middle + Vec2{reach, reach});
  for (std::int32_t j = low.j; j <= high.j; ++j) {
    for (std::int32_t i = low.i; i <= high.i; ++i) {
      const bool covered = body.distance_to(robot_from_map * map.centre_of({i, j})) == 0.0;
      if (covered && map.evidence({i, j}) == 0) map.add({i, j}, kPass);
    }
  }
}

void MapEntry::enter(EvidenceMap& map, Vec2 laser, const std::array<Vec2, kMaxBeams>& points, const Entries& entries,
                     std::size_t count, double step_s) noexcept {
  if (++scan_ == 0) {  // the count of scans ran over: old marks would look new
    std::fill(visited_in_.begin(), visited_in_.end(), std::uint16_t{0});
    scan_ = 1;
  }
  for (std::size_t k = 0; k < count; ++k) {
    const CellIndex cell = map.cell_at(points[k]);
    if (entries[k] == Becomes::kNothing || !map.contains(cell)) continue;
    const bool first = first_visit(map.slot(cell));
    const Vec2 back = laser - points[k];
    map.add_hit(points[k], first ? kHit : 0, first && entries[k] == Becomes::kWall ? step_s : 0.0,
                back * (1.0 / std::max(norm(back), kNearestM)));
  }
  for (std::size_t k = 0; k < count; ++k) free_along(map, laser, points[k]);
}

}  // namespace jaywalk
