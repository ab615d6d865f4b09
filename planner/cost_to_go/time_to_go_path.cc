#include "planner/cost_to_go/time_to_go_path.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "planner/cost_to_go/planning_rules.h"

namespace jaywalk::field {
namespace {

constexpr double kPathSpacing_m = 0.1;
constexpr std::int32_t kLongestPiece = 64;  ///< cells along the way that one straight piece may stand for
constexpr double kRounding = 1.02;          ///< lengths of steps are whole numbers, and go in sixteen directions

void append_line(Path& path, Vec2 to) noexcept {
  const Vec2 from = path.back();
  const double pieces = std::ceil(distance(from, to) / kPathSpacing_m);
  for (double k = 1.0; k <= pieces; ++k) {
    if (!path.push_back(k < pieces ? from + (to - from) * (k / pieces) : to)) return;
  }
}

}  // namespace

TimeToGoPath::TimeToGoPath(const TimeToGoField& field, const TimeToGoRequest& request) noexcept
    : field_(field), request_(request), graph_(field.graph()) {
  const CellIndex robot = request.window.cell_at(request.robot_in_map);
  own_ = graph_.at(robot.i, robot.j);
  start_ = graph_.is_free(own_) ? own_ : nearest_to_robot(true);
}

/// Within kStartRadius_m the nearest free cell, or the nearest with a way to the goal.
std::int32_t TimeToGoPath::nearest_to_robot(bool has_way) const noexcept {
  const Grid grid = request_.window.grid();
  const CellIndex robot = request_.window.cell_at(request_.robot_in_map);
  const auto node = [&](std::int32_t c) { return graph_.at(c % grid.side, c / grid.side); };
  const auto radius = static_cast<std::int32_t>(std::floor(kStartRadius_m / request_.window.cell_m + 0.5));
  const std::int32_t c = nearest_cell(grid, robot.i, robot.j, radius, [&](std::int32_t at) {
    return has_way ? graph_.has_way(node(at)) : graph_.is_free(node(at));
  });
  return c == kNoCell ? CellGraph::kNone : node(c);
}

PlanStatus TimeToGoPath::status() const noexcept {
  if (start_ != CellGraph::kNone) return graph_.has_way(start_) ? PlanStatus::kOk : PlanStatus::kNoPath;
  return nearest_to_robot(false) == CellGraph::kNone ? PlanStatus::kRobotBlocked : PlanStatus::kNoPath;
}

bool TimeToGoPath::is_walled_off(Flood& flood) const noexcept {
  const Window& window = request_.window;
  if (!window.holds(request_.goal_in_map, 0)) return false;
  const CellIndex start = graph_.cell_of(graph_.is_free(own_) ? own_ : nearest_to_robot(false));
  flood.fill(window.grid(), window.grid().at(start.i, start.j), true,
             [&](std::int32_t c) { return graph_.is_free(graph_.at(c % window.side, c / window.side)); });
  return flood.touches_border();
}

void TimeToGoPath::draw(Path& path) const noexcept {
  path.clear();
  (void)path.push_back(request_.robot_in_map);
  if (start_ != own_) append_line(path, middle_of(start_));
  std::int32_t n = start_;
  for (std::int32_t next = straight_on(n); next != CellGraph::kNone; next = straight_on(n)) {
    if (n != start_) append_line(path, middle_of(n));
    n = next;
  }
  const CellIndex goal = request_.window.cell_at(request_.goal_in_map);
  const bool arrives = request_.window.holds(request_.goal_in_map, 0) && graph_.is_free(graph_.at(goal.i, goal.j));
  append_line(path, arrives ? request_.goal_in_map : middle_of(n));  // n is then the goal's cell or beside it
}

/// The cell that a straight piece of the path leads to from this one; kNone at the path's end.
std::int32_t TimeToGoPath::straight_on(std::int32_t n) const noexcept {
  std::int32_t reached = graph_.next(n);
  for (std::int32_t steps = 1; reached != CellGraph::kNone && steps < kLongestPiece; steps *= 2) {
    std::int32_t farther = reached;
    for (std::int32_t k = 0; k < steps; ++k) {
      const std::int32_t next = graph_.next(farther);
      if (next == CellGraph::kNone) break;
      farther = next;
    }
    if (farther == reached || !costs_no_more(n, farther)) break;
    reached = farther;
  }
  return reached;
}

/// Whether the straight line between two cells costs no more than the way down from one to the other.
bool TimeToGoPath::costs_no_more(std::int32_t from, std::int32_t to) const noexcept {
  const CellIndex a = graph_.cell_of(from), b = graph_.cell_of(to);
  const double di = b.i - a.i, dj = b.j - a.j;
  const std::int32_t pieces = std::max(std::abs(b.i - a.i), std::abs(b.j - a.j));
  const double length = std::sqrt(di * di + dj * dj) / pieces * kStraightLength;
  double cost = 0.0;
  for (std::int32_t k = 0; k <= pieces; ++k) {
    const std::uint32_t rate =
        graph_.rate(graph_.at(a.i + static_cast<std::int32_t>(std::floor(di * k / pieces + 0.5)),
                              a.j + static_cast<std::int32_t>(std::floor(dj * k / pieces + 0.5))));
    if (rate == 0) return false;
    cost += length * rate * (k == 0 || k == pieces ? 1.0 : 2.0);
  }
  return cost <= kRounding * (graph_.cost(from) - graph_.cost(to));
}

Vec2 TimeToGoPath::middle_of(std::int32_t n) const noexcept {
  const CellIndex cell = graph_.cell_of(n);
  return request_.window.in_map({cell.i + 0.5, cell.j + 0.5});
}

}  // namespace jaywalk::field
