#pragma once
#include <span>

#include "planner/cost_to_go/planner.h"
#include "planner/mapping/window.h"
#include "planner/paper/band.h"

namespace jaywalk::paper {

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
