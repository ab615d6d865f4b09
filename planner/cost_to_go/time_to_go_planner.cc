#include "planner/cost_to_go/time_to_go_planner.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

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

const PlannerConfig& checked(const PlannerConfig& config) { return check(config), config; }

/// Status and path of a plan, from costs that were just settled for this request. Refers to both.
class TimeToGoPath {
 public:
  TimeToGoPath(const CellGraph& graph, const PlanRequest& request, const Window& window) noexcept
      : window_(window),
        graph_(graph),
        robot_(request.map_from_robot.position()),
        goal_(request.goal_in_map),
        own_(graph.at(window_.cell_at(robot_))),
        start_(graph.is_free(own_) ? own_ : nearest_to_robot(true)) {}

  /// kOk, kNoPath or kRobotBlocked. Costs are a fixed point: kNoPath is proven on the grid, unless the field is not
  /// certified.
  [[nodiscard]] PlanStatus status() const noexcept {
    if (start_ != CellGraph::kNone) return graph_.has_way(start_) ? PlanStatus::kOk : PlanStatus::kNoPath;
    return nearest_to_robot(false) == CellGraph::kNone ? PlanStatus::kRobotBlocked : PlanStatus::kNoPath;
  }

  /// Of kNoPath: whether the goal is inside the window and what the robot can reach goes on beyond the window.
  [[nodiscard]] bool is_walled_off(Flood& flood) const noexcept {
    if (!window_.holds(goal_, 0)) return false;
    const CellIndex start = graph_.cell_of(graph_.is_free(own_) ? own_ : nearest_to_robot(false));
    flood.fill(window_.grid(), window_.grid().at(start.i, start.j), true,
               [&](std::int32_t c) { return graph_.is_free(node(c)); });
    return flood.touches_border();
  }

  /// Of kOk: from the robot down the costs, straight on where that costs no more.
  void draw(Path& path) const noexcept {
    path.clear();
    (void)path.push_back(robot_);
    if (start_ != own_) append_line(path, middle_of(start_));
    std::int32_t n = start_;
    for (std::int32_t next = straight_on(n); next != CellGraph::kNone; next = straight_on(n)) {
      if (n != start_) append_line(path, middle_of(n));
      n = next;
    }
    const bool arrives = window_.holds(goal_, 0) && graph_.is_free(graph_.at(window_.cell_at(goal_)));
    append_line(path, arrives ? goal_ : middle_of(n));  // n is then the goal's cell or beside it
  }

 private:
  /// Within kStartRadius_m the nearest free cell, or the nearest with a way to the goal.
  [[nodiscard]] std::int32_t nearest_to_robot(bool has_way) const noexcept {
    const CellIndex robot = window_.cell_at(robot_);
    const auto radius = static_cast<std::int32_t>(std::floor(kStartRadius_m / window_.cell_m + 0.5));
    const std::int32_t c = nearest_cell(window_.grid(), robot.i, robot.j, radius, [&](std::int32_t at) {
      return has_way ? graph_.has_way(node(at)) : graph_.is_free(node(at));
    });
    return c == kNoCell ? CellGraph::kNone : node(c);
  }

  /// The cell that a straight piece of the path leads to from this one; kNone at the path's end.
  [[nodiscard]] std::int32_t straight_on(std::int32_t n) const noexcept {
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
  [[nodiscard]] bool costs_no_more(std::int32_t from, std::int32_t to) const noexcept {
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

  [[nodiscard]] std::int32_t node(std::int32_t c) const noexcept {
    return graph_.at(c % window_.side, c / window_.side);
  }
  [[nodiscard]] Vec2 middle_of(std::int32_t n) const noexcept {
    const CellIndex cell = graph_.cell_of(n);
    return window_.in_map({cell.i + 0.5, cell.j + 0.5});
  }

  const Window& window_;
  const CellGraph& graph_;
  Vec2 robot_, goal_;
  std::int32_t own_, start_;  ///< the robot's cell; the one that its way begins in, CellGraph::kNone without one
};

}  // namespace

TimeToGoPlanner::TimeToGoPlanner(const PlannerConfig& config, std::unique_ptr<CostSettler> device)
    : device_(std::move(device)),
      window_({{0, 0}, checked(config).side_cells, config.cell_m}, config.max_side_cells),
      far_(config.cell_m, config.known_map),
      cells_(config.body.inscribed_radius_m(), config.body.circumscribed_radius_m(), config.max_side_cells,
             config.keep_out, device_.get(), &far_),
      poses_(config.body, device_.get()),
      flood_(Grid{config.max_side_cells}.cells()),
      results_{Result(config.max_side_cells), Result(config.max_side_cells)} {}

FieldView TimeToGoPlanner::view_field() const {
  const Result& result = results_[shown()];
  drawn_.assign(static_cast<std::size_t>(result.window.grid().cells()), 0.0F);
  cells_.draw(result.guide, drawn_.data());
  return {.of = FieldView::Of::kTimeToGo,
          .low = result.window.low,
          .width = result.window.side,
          .height = result.window.side,
          .cell_m = window_.now().cell_m,
          .psi = drawn_};
}

/// Settles on the CPU what a failed device has not; the status tells the failure all the same.
PlanStatus TimeToGoPlanner::answer(const PlanRequest& request, Plan& plan) noexcept {
  if (device_ && !device_->is_ready()) return PlanStatus::kBackendFailed;
  const PlanStatus status = plan_by_times(request, plan);
  return device_ && *device_->failure() != '\0' ? PlanStatus::kBackendFailed : status;
}

PlanStatus TimeToGoPlanner::plan_by_times(const PlanRequest& request, Plan& plan) noexcept {
  if (!is_finite(request)) return PlanStatus::kBadRequest;
  const Vec2 robot = request.map_from_robot.position(), goal = request.goal_in_map;
  window_.place(robot, goal);
  if (!window_.now().holds(goal, 0)) far_.settle(request.stamp, request.still, robot, goal);
  Result& result = results_[making()];
  result.window = window_.now();
  plan.guide = result.guide = cells_.settle(request, result.window, result.cells);
  if (request.poses.is_asked) plan.poses = poses_.settle(request, plan.guide, result.poses);
  plan.certified = cells_.is_certified();
  plan.reach = plan.certified ? 1.0F : 0.0F;
  const TimeToGoPath path(cells_.graph(), request, result.window);
  const bool is_closed = path.status() == PlanStatus::kOk && plan.poses.goal_closed;
  const PlanStatus status = is_closed ? PlanStatus::kNoPath : path.status();
  if (status == PlanStatus::kOk) path.draw(plan.path);
  window_.note_walled_off(status == PlanStatus::kNoPath && !is_closed && window_.can_grow() &&
                          path.is_walled_off(flood_));
  return status;
}

}  // namespace jaywalk::field
