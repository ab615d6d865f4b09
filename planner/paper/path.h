#pragma once
// Path by the index matrix, and the paper's fourth kernel, the rubber band, which pulls it taut on the host.
#include <cmath>
#include <span>

#include "planner/cost_to_go/planner.h"
#include "planner/mapping/window.h"
#include "planner/paper/executor.h"

namespace jaywalk::paper {
struct Point {
  float x, y;
};

/// Tension of the two neighbours on a point of the band (T_{i-1} + T_{i+1}, halved): towards their middle.
JAYWALK_CELL Point tension(Point before, Point here, Point after) {
  return {0.5F * (before.x + after.x) - here.x, 0.5F * (before.y + after.y) - here.y};
}

/// Force of the clearance potential (1 - D/reach)^2 reach/4 below `reach` cells of clearance D, zero
/// above: sideways, away from what is near. `slope` is the gradient of D.
///
/// The paper's F is a difference of 1/(1 - phi) = e^psi (equation force), which grows by e^k a cell and swamps the
/// tension; ln of it, psi, drags points along the band. The clearance acts across it.
JAYWALK_CELL Point clearance_force(float clearance, Point slope, float reach) {
  if (clearance >= reach) return {0.0F, 0.0F};
  const float strength = 0.5F * (1.0F - clearance / reach);
  return {strength * slope.x, strength * slope.y};
}

/// Cosine of the sharpest turn that a move may make at a point of the band: 45 degrees.
inline constexpr float kSharpest = 0.70710678F;

/// Cosine of the turn at `here`; NaN where two of the points coincide.
JAYWALK_CELL float turn_cosine(Point before, Point here, Point after) {
  const float ax = here.x - before.x, ay = here.y - before.y, bx = after.x - here.x, by = after.y - here.y;
  return (ax * bx + ay * by) / std::sqrt((ax * ax + ay * ay) * (bx * bx + by * by));
}

/// The point moved by its resultant force (equations resultant and drag). With a `give` below 1 it does not swing.
JAYWALK_CELL Point dragged(Point here, Point pull, Point force, float give) {
  return {here.x + give * (pull.x + force.x), here.y + give * (pull.y + force.y)};
}

/// Most cells that a raw path may have; a longer one is cut there, and leads towards the goal.
inline constexpr std::int32_t kMaxBandPoints = 16384;

/// Pulls the band taut; points (in cells) before `first` and the last stay. `raw` has room for as many.
///
/// Invariants of a move, whatever the force:
/// - Free cells: all cells of the box that two neighbouring points span are free, so the segment between is in free
///   cells. The raw path begins so, since its diagonal steps lie between two free cells.
/// - No turning back: the sharpest turn, at the point and at its neighbours, is at most 45 degrees, or no sharper than
///   before.
/// The band is no longer than the raw path: where clearance has made it so, tension alone, which never lengthens, draws
/// it in, and where that takes too long, tension alone acts on the raw path.
void pull(Grid grid, const float* clearance, std::span<Point> points, std::span<Point> raw,
          std::int32_t first) noexcept;

using field::Window;

/// Follows the index matrix from `start` to `goal` and appends the centres of the cells to `points`, from
/// place `count` on and as many as there is room for. Returns how many there are then; 0 when the way does not arrive.
[[nodiscard]] std::int32_t follow(Grid grid, const std::uint8_t* index, std::int32_t start, std::int32_t goal,
                                  std::span<Point> points, std::int32_t count) noexcept;

/// Share of the joined cells (psi below infinity) from which following the index matrix arrives at `goal`.
/// `seen` has room for a byte a cell.
[[nodiscard]] float share_arriving(Grid grid, const float* psi, const std::uint8_t* index, std::int32_t goal,
                                   std::uint8_t* seen) noexcept;

/// The band as a path in the map: 0.1 m apart or a little less, wider (at most 0.2 m) where it would not fit, cut at
/// kMaxPathPoints beyond that, and closer at the band's corners: where the straight line from one place to the next
/// would leave free cells (`clearance` above 0, by rows) it goes by the corner instead. First and last point exactly
/// `from` and `to`.
void resample(const Window& window, const float* clearance, std::span<const Point> points, Vec2 from, Vec2 to,
              Path& path) noexcept;

}  // namespace jaywalk::paper
