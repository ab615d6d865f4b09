#pragma once
// On any executor: the paper's planner, which chooses window, goal and start, runs the pass, and draws the path; and
// the potential of a map alone.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "planner/cost_to_go/time_to_go_planner.h"
#include "planner/paper/map_field.h"
#include "planner/paper/paper.h"
#include "planner/paper/pass.h"
#include "planner/paper/path.h"

namespace jaywalk::paper {
template <class Executor>
class PaperPlanner final : public AnsweringPlanner {
 public:
  PaperPlanner(const PaperConfig& config, std::unique_ptr<Executor> executor)
      : config_(config),
        executor_(std::move(executor)),
        pass_(*executor_, config.max_side_cells),
        flood_(Grid{config.max_side_cells}.cells()),
        window_({{0, 0}, config.side_cells, config.cell_m}, config.max_side_cells),
        times_(std::make_unique<field::TimeToGoPlanner>(config)),
        points_(static_cast<std::size_t>(kMaxBandPoints)),
        raw_(points_.size()) {
    for (Result& result : results_) result.psi.resize(static_cast<std::size_t>(Grid{config.max_side_cells}.cells()));
  }

  [[nodiscard]] FieldView view_field() const override {
    const Result& result = results_[shown()];
    const auto cells = static_cast<std::size_t>(result.window.grid().cells());
    return {.of = FieldView::Of::kPotential,
            .low = result.window.low,
            .width = result.window.side,
            .height = result.window.side,
            .cell_m = config_.cell_m,
            .psi = {result.psi.data(), cells}};
  }
  [[nodiscard]] const char* backend() const noexcept override { return executor_->name(); }
  [[nodiscard]] const char* failure() const noexcept override { return executor_->failure(); }

  /// Arrays after the last submission. For tests.
  [[nodiscard]] const FieldArrays& arrays() const noexcept { return pass_.shown(); }

 private:
  struct Result {
    Window window;
    std::vector<float> psi;
  };

  [[nodiscard]] double device_ms() const noexcept override { return executor_->took_ms(); }
  [[nodiscard]] const Window& window() const noexcept { return window_.now(); }
  [[nodiscard]] std::int32_t cells(double metres) const noexcept {
    return static_cast<std::int32_t>(std::floor(metres / config_.cell_m + 0.5));
  }
  [[nodiscard]] float inflation() const noexcept { return static_cast<float>(config_.inflation_m / config_.cell_m); }
  [[nodiscard]] bool is_free(std::int32_t c) const noexcept { return pass_.shown().clearance[c] > 0.0F; }

  /// The free cell nearest the robot, within kStartRadius_m.
  [[nodiscard]] std::int32_t nearest_free(CellIndex robot) const noexcept {
    return nearest_cell(window().grid(), robot.i, robot.j, cells(field::kStartRadius_m),
                        [this](std::int32_t c) { return is_free(c); });
  }

  PlanStatus answer(const PlanRequest& request, Plan& plan) noexcept override {
    if (!executor_->is_ready()) return PlanStatus::kBackendFailed;
    if (!field::is_finite(request)) return PlanStatus::kBadRequest;
    window_.place(request.map_from_robot.position(), request.goal_in_map);
    Result& result = results_[making()];
    result.window = window();
    std::fill_n(result.psi.begin(), window().grid().cells(), cell::kNotFree);
    const PlanStatus status = plan_by_potential(request, result.psi.data(), plan);
    if (*executor_->failure() != '\0') return PlanStatus::kBackendFailed;
    times_->submit(request);
    plan.guide = times_->collect().guide;
    return status;
  }

  PlanStatus plan_by_potential(const PlanRequest& request, float* psi, Plan& plan) noexcept {
    const Grid grid = window().grid();
    const FieldArrays& a = pass_.shown();
    fetch_walls(window(), request.still, a.occupants);
    if (config_.keep_out)
      fetch_keep_out(window(), config_.keep_out->view(), request.map_from_robot.position(), a.occupants);
    fetch_standing(window(), request.standing, a.occupants);
    const std::int32_t movers = fetch_movers(window(), request.moving, a.movers, mover_ids_);
    if (!pass_.mark(grid, warping_for(config_, window(), request), movers)) return PlanStatus::kBackendFailed;
    if (!pass_.clear(grid, inflation(), kWall | kMover)) return PlanStatus::kBackendFailed;
    report_predictions(movers, plan);
    const CellIndex robot = window().cell_at(request.map_from_robot.position());
    if (nearest_free(robot) == kNoCell) return window_.note_walled_off(false), PlanStatus::kRobotBlocked;
    const std::int32_t goal = choose_goal(request, robot);
    const PlanStatus status = goal == kNoCell ? PlanStatus::kNoPath : descend(request, robot, goal, psi, plan);
    if (status == PlanStatus::kNoPath) {
      consider_growing(request);
    } else {
      window_.note_walled_off(false);
    }
    return status;
  }

  void report_predictions(std::int32_t movers, Plan& plan) const noexcept {
    for (std::int32_t k = 0; k < movers; ++k) {
      const Mark& mark = pass_.shown().marks[k];
      (void)plan.predictions.push_back(
          {.track_id = mover_ids_[static_cast<std::size_t>(k)],
           .position_in_map = window().in_map({static_cast<double>(mark.x), static_cast<double>(mark.y)}),
           .mark_radius_m = static_cast<double>(mark.radius) * config_.cell_m});
    }
  }

  /// The goal's cell when it is free; else the nearest in the robot's reach: round a goal inside the
  /// window, anywhere on the border for one outside it.
  [[nodiscard]] std::int32_t choose_goal(const PlanRequest& request, CellIndex robot) noexcept {
    const Grid grid = window().grid();
    const bool inside = window().holds(request.goal_in_map, 0);
    const CellIndex wanted = projected_goal(window(), request.map_from_robot.position(), request.goal_in_map);
    if (inside && is_free(grid.at(wanted.i, wanted.j))) return grid.at(wanted.i, wanted.j);
    fill_from(nearest_free(robot));
    if (!inside) {
      return nearest_cell(grid, wanted.i, wanted.j, 2 * grid.side, [&](std::int32_t c) {
        const std::int32_t i = c % grid.side, j = c / grid.side;
        return (i == 0 || j == 0 || i == grid.side - 1 || j == grid.side - 1) && flood_.holds(c);
      });
    }
    const double radius = has_mover_near(wanted) ? kGoalRadiusBesideMover_m : field::kGoalRadius_m;
    return nearest_cell(grid, wanted.i, wanted.j, cells(radius), [this](std::int32_t c) { return flood_.holds(c); });
  }

  /// True where a mover's mark keeps this cell from being free.
  [[nodiscard]] bool has_mover_near(CellIndex at) const noexcept {
    return nearest_cell(window().grid(), at.i, at.j, cells(config_.inflation_m),
                        [this](std::int32_t c) { return (pass_.shown().occupants[c] & kMover) != 0; }) != kNoCell;
  }

  /// Field, index matrix, band and path to a free goal cell.
  PlanStatus descend(const PlanRequest& request, CellIndex robot, std::int32_t goal, float* psi, Plan& plan) noexcept {
    const FieldArrays& a = pass_.shown();
    const Grid grid = window().grid();
    const bool warm = solved_goal_ == goal && solved_window_ == window();
    const Disc near{robot.i, robot.j, cells(field::kStartRadius_m)};
    const FieldQuality quality = pass_.solve(grid, goal, warm ? From::kLast : From::kNothing, near);
    if (!quality.done) return PlanStatus::kBackendFailed;
    if (quality.joined == 0) return PlanStatus::kNoPath;
    std::copy_n(a.psi, grid.cells(), psi);
    const std::int32_t start =
        nearest_cell(grid, near.i, near.j, near.radius, [&](std::int32_t c) { return cell::is_joined(psi[c]); });
    solved_goal_ = goal;
    solved_window_ = window();
    plan.certified = quality.certified;
    plan.cycles = quality.cycles;
    // Nothing reads the occupants any more: room for the count.
    plan.reach = quality.certified ? 1.0F : share_arriving(grid, psi, a.index, goal, a.occupants);
    return draw(request, grid.at(robot.i, robot.j) == start, start, goal, plan.path);
  }

  /// The raw path, pulled taut and resampled. A robot in its own cell stands for that cell; one that first has to
  /// leave an obstacle's inflation goes straight to the start cell, and that leg is not pulled.
  PlanStatus draw(const PlanRequest& request, bool starts_free, std::int32_t start, std::int32_t goal,
                  Path& path) noexcept {
    const auto point_at = [this](Vec2 p) {
      const Vec2 there = window().in_cells(p);
      return Point{static_cast<float>(there.x), static_cast<float>(there.y)};
    };
    const FieldArrays& a = pass_.shown();
    const Vec2 from = request.map_from_robot.position();
    const std::int32_t fixed = starts_free ? 0 : 1;  // points before the start cell's
    const std::int32_t count = follow(window().grid(), a.index, start, goal, points_, fixed);
    if (count == 0) return PlanStatus::kNoPath;
    const std::span<Point> points(points_.data(), static_cast<std::size_t>(count));
    points[0] = point_at(from);
    const CellIndex wanted = window().cell_at(request.goal_in_map);
    const bool at_true_goal = window().holds(request.goal_in_map, 0) && window().grid().at(wanted.i, wanted.j) == goal;
    const Point last = points.back();
    const Vec2 end = at_true_goal ? request.goal_in_map
                                  : window().in_map({static_cast<double>(last.x), static_cast<double>(last.y)});
    if (at_true_goal && count > 1) points.back() = point_at(end);
    pull(window().grid(), a.clearance, points, raw_, fixed + 1);
    resample(window(), a.clearance, points, from, end, path);
    return PlanStatus::kOk;
  }

  /// Grows the window where walls alone keep the goal away: movers go.
  void consider_growing(const PlanRequest& request) noexcept {
    const Grid grid = window().grid();
    if (!window_.can_grow() || !pass_.clear(grid, inflation(), kWall)) return;
    const std::int32_t start = nearest_free(window().cell_at(request.map_from_robot.position()));
    if (start == kNoCell) return;
    fill_from(start);
    const CellIndex goal = window().cell_at(request.goal_in_map);
    window_.note_walled_off(flood_.touches_border() && window().holds(request.goal_in_map, 0) &&
                            nearest_cell(grid, goal.i, goal.j, cells(field::kGoalRadius_m),
                                         [this](std::int32_t c) { return flood_.holds(c); }) == kNoCell);
  }

  void fill_from(std::int32_t free_cell) noexcept {
    flood_.fill(window().grid(), free_cell, false, [this](std::int32_t c) { return is_free(c); });
  }

  PaperConfig config_;
  std::unique_ptr<Executor> executor_;
  Pass<Executor> pass_;
  field::Flood flood_;
  field::GrowingWindow window_;
  Window solved_window_;  ///< that the potential was last solved on, and for which goal cell
  std::int32_t solved_goal_ = kNoCell;
  std::unique_ptr<Planner> times_;  ///< the plan's guide, for reports
  std::vector<Point> points_, raw_;
  std::array<std::uint32_t, kMaxTracks> mover_ids_{};
  std::array<Result, 2> results_;  ///< as AnsweringPlanner numbers them
};

/// A MapField on any executor, which it owns.
template <class Executor>
class MapFieldOn final : public MapField {
 public:
  MapFieldOn(CellMap map, std::unique_ptr<Executor> executor)
      : map_(std::move(map)), executor_(std::move(executor)), pass_(*executor_, grid_.side) {
    MapFieldOn::inflate(0.0F);
  }

  void inflate(float inflation) noexcept override {
    inflation_ = inflation;
    for (std::int32_t j = 0; j < map_.height; ++j) {
      const auto row = map_.wall.begin() + static_cast<std::ptrdiff_t>(j) * map_.width;
      for (std::int32_t i = 0; i < map_.width; ++i)
        pass_.shown().occupants[grid_.at(i, j)] = row[i] != 0 ? std::uint8_t{kWall} : std::uint8_t{0};
    }
    (void)pass_.clear(grid_, map_.width, map_.height, inflation, kWall);
  }

  [[nodiscard]] bool nearest_free(CellIndex& at, std::int32_t radius) const noexcept override {
    const float* clearance = pass_.shown().clearance;
    const std::int32_t found =
        nearest_cell(grid_, at.i, at.j, radius, [clearance](std::int32_t c) { return clearance[c] > 0.0F; });
    if (found == kNoCell) return false;
    at = {found % grid_.side, found / grid_.side};
    return true;
  }

  FieldQuality solve_cold(CellIndex goal) noexcept override {
    inflate(inflation_);
    return solve(goal, From::kNothing);
  }
  FieldQuality solve_warm(CellIndex goal) noexcept override { return solve(goal, From::kLast); }
  FieldQuality solve_start(CellIndex goal) noexcept override { return solve(goal, From::kStartOnly); }

  [[nodiscard]] float reach(CellIndex goal) noexcept override {
    std::vector<std::uint8_t> seen(static_cast<std::size_t>(grid_.cells()));
    return share_arriving(grid_, pass_.shown().psi, pass_.shown().index, grid_.at(goal.i, goal.j), seen.data());
  }

  [[nodiscard]] std::optional<double> best_neighbours(CellIndex goal, double most) const override {
    std::vector<std::uint8_t> free(static_cast<std::size_t>(grid_.cells()));
    for (std::size_t c = 0; c < free.size(); ++c) free[c] = pass_.shown().clearance[c] > 0.0F ? 1 : 0;
    const std::int32_t at = grid_.at(goal.i, goal.j);
    const std::vector<double> exact = exact_psi(grid_, free.data(), at, most);
    if (exact.empty()) return std::nullopt;
    return share_of_best(grid_, pass_.shown().psi, exact, at);
  }

  [[nodiscard]] float psi(std::int32_t i, std::int32_t j) const noexcept override {
    return pass_.shown().psi[grid_.at(i, j)];
  }
  [[nodiscard]] const char* backend() const noexcept override { return executor_->name(); }
  [[nodiscard]] double device_ms() const noexcept override { return executor_->took_ms(); }

 private:
  FieldQuality solve(CellIndex goal, From from) noexcept { return pass_.solve(grid_, grid_.at(goal.i, goal.j), from); }

  CellMap map_;
  float inflation_ = 0.0F;
  std::unique_ptr<Executor> executor_;
  Grid grid_{
      static_cast<std::int32_t>(std::bit_ceil(static_cast<std::uint32_t>(std::max({map_.width, map_.height, 64}))))};
  Pass<Executor> pass_;
};

}  // namespace jaywalk::paper
