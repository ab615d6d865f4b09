#include "planner/mapping/window.h"

#include <cmath>

namespace jaywalk::field {
namespace {
/// Points farther out than this would overflow cell numbers; they are as good as at infinity.
constexpr double kFarthestCells = 5e8;

double cells(double metres, double cell_m) { return std::clamp(metres / cell_m, -kFarthestCells, kFarthestCells); }

bool fits(double robot, double goal, std::int32_t side) {
  return std::fabs(goal - robot) <= side - 2.0 * kWindowMargin;
}

/// Lowest cell along one axis, all in cells: between robot and goal where both fit, else with the
/// robot twice the roll margin from the border behind it.
std::int32_t low_along(double robot, double goal, std::int32_t side) {
  const double half = side / 2.0;
  const double ahead = half - std::min(2.0 * kWindowRollMargin, half / 2.0);
  const double towards = std::clamp(goal - robot, -ahead, ahead);
  const double centre = fits(robot, goal, side) ? (robot + goal) / 2.0 : robot + towards;
  return static_cast<std::int32_t>(std::floor((centre - half) / kWindowBlock + 0.5)) * kWindowBlock;
}

}  // namespace

CellIndex Window::cell_at(Vec2 p) const {
  return {static_cast<std::int32_t>(std::floor(cells(p.x, cell_m))) - low.i,
          static_cast<std::int32_t>(std::floor(cells(p.y, cell_m))) - low.j};
}

Vec2 Window::in_cells(Vec2 p) const { return {cells(p.x, cell_m) - low.i, cells(p.y, cell_m) - low.j}; }

Window placed(const Window& now, Vec2 robot, Vec2 goal) {
  constexpr std::int32_t kLeastMargin = 5;
  const bool goal_inside = now.holds(goal, 0);
  const double rx = cells(robot.x, now.cell_m), ry = cells(robot.y, now.cell_m);
  const double gx = cells(goal.x, now.cell_m), gy = cells(goal.y, now.cell_m);
  const bool goal_could_be_inside = fits(rx, gx, now.side) && fits(ry, gy, now.side);
  const bool serves = now.holds(robot, goal_inside ? kLeastMargin : std::min(kWindowRollMargin, now.side / 8)) &&
                      (goal_inside || !goal_could_be_inside);
  if (serves) return now;
  return {{low_along(rx, gx, now.side), low_along(ry, gy, now.side)}, now.side, now.cell_m};
}

void GrowingWindow::note_walled_off(bool walled_off) noexcept {
  walled_off_ = walled_off ? walled_off_ + 1 : 0;
  if (walled_off_ < kPatience || !can_grow()) return;
  now_ = {{now_.low.i - now_.side / 2, now_.low.j - now_.side / 2}, 2 * now_.side, now_.cell_m};
  walled_off_ = 0;
}

CellIndex projected_goal(const Window& window, Vec2 robot, Vec2 goal) {
  if (window.holds(goal, 0)) return window.cell_at(goal);
  const Vec2 from = window.in_cells(robot), to = window.in_cells(goal);
  const double last = window.side - 1.0;
  double share = 1.0;  // of the way to the goal that lies inside; the robot does
  for (const auto [start, end] : {Vec2{from.x, to.x}, Vec2{from.y, to.y}}) {
    if (end > last) share = std::min(share, (last - start) / (end - start));
    if (end < 0.0) share = std::min(share, start / (start - end));
  }
  share = std::max(share, 0.0);
  const Vec2 p = from + (to - from) * share;
  return {static_cast<std::int32_t>(std::clamp(std::floor(p.x), 0.0, last)),
          static_cast<std::int32_t>(std::clamp(std::floor(p.y), 0.0, last))};
}

}  // namespace jaywalk::field
