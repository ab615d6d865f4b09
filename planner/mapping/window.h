#pragma once
#include "hal/types/geometry.h"
#include "planner/mapping/evidence_map.h"
#include "planner/mapping/nearest_cell.h"

namespace jaywalk::field {

/// The square of the world that is planned on. Anchored: it stays where it is while that serves, and
/// moves by whole blocks, so that cells are the same cells from tick to tick.
struct Window {
  CellIndex low;  ///< world index of its lowest cell
  std::int32_t side = 0;
  double cell_m = 0.1;

  bool operator==(const Window&) const = default;
  [[nodiscard]] Grid grid() const { return {side}; }
  /// Cell of a point, counted from `low`; not necessarily inside.
  [[nodiscard]] CellIndex cell_at(Vec2 p_in_map) const;
  /// A point in cells from the window's low corner: the centre of cell (0, 0) is (0.5, 0.5).
  [[nodiscard]] Vec2 in_cells(Vec2 p_in_map) const;
  [[nodiscard]] Vec2 in_map(Vec2 p_in_cells) const;
  /// Whether a point lies inside with `margin` cells to spare.
  [[nodiscard]] bool holds(Vec2 p_in_map, std::int32_t margin) const;
};

/// Cells by which a window moves.
inline constexpr std::int32_t kWindowBlock = 16;
/// Room (cells) round the box of robot and goal that a window of that size needs: 1.5 m at 0.1 m.
inline constexpr std::int32_t kWindowMargin = 15;
/// A window that does not hold the goal moves on when the robot is this near its border: 3 m.
inline constexpr std::int32_t kWindowRollMargin = 30;

/// The window for a robot and a goal: `now` while it serves, else one between the two where they both
/// fit, else one that holds the robot and looks towards the goal.
[[nodiscard]] Window placed(const Window& now, Vec2 robot_in_map, Vec2 goal_in_map);

/// The same centre, twice the side.
[[nodiscard]] Window doubled(const Window& now);

/// Submissions in a row that walls alone keep from the goal before the window doubles: a second at 15 scans a
/// second. A doorway that noise closes for a scan must not quadruple the work for good.
inline constexpr int kPatience = 15;

/// A planner's window: it follows robot and goal, and doubles where a way round may lie outside it.
class GrowingWindow {
 public:
  GrowingWindow(const Window& first, std::int32_t max_side) : now_(first), max_side_(max_side) {}

  [[nodiscard]] const Window& now() const noexcept { return now_; }
  void place(Vec2 robot_in_map, Vec2 goal_in_map) noexcept { now_ = placed(now_, robot_in_map, goal_in_map); }
  [[nodiscard]] bool can_grow() const noexcept { return 2 * now_.side <= max_side_; }
  /// After each plan: whether walls alone keep the robot from a goal inside the window, and the robot can leave the
  /// window. Doubles it, for the next plan, when that was so kPatience times in a row.
  void note_walled_off(bool walled_off) noexcept;

 private:
  Window now_;
  std::int32_t max_side_;
  int walled_off_ = 0;  ///< plans in a row
};

/// Where a goal outside projects onto the border along its line from the robot, in cells; a goal inside as it is.
[[nodiscard]] CellIndex projected_goal(const Window& window, Vec2 robot_in_map, Vec2 goal_in_map);

}  // namespace jaywalk::field
