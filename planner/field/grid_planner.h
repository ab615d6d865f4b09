#pragma once
// The planner: the time to go, and where it is asked for the potential on any executor: chooses window, goal and
// start, runs the pass, and draws the path.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "planner/cost_to_go/guide_field.h"
#include "planner/cost_to_go/pose_field.h"
#include "planner/field/nearest_cell.h"
#include "planner/field/pass.h"
#include "planner/field/path.h"
#include "planner/field/plan_clock.h"
#include "planner/field/planning_rules.h"
#include "planner/field/time_to_go_path.h"

namespace jaywalk::field {

template <class Executor>
class GridPlanner final : public Planner {
 public:
  GridPlanner(const PlannerConfig& config, std::unique_ptr<Executor> executor)
      : config_(config),
        executor_(std::move(executor)),
        pass_(*executor_, config.max_side_cells),
        flood_(Grid{config.max_side_cells}.cells()),
        window_({{0, 0}, config.side_cells, config.cell_m}, config.max_side_cells),
        time_to_go_(config.body.inscribed_radius_m(), config.body.circumscribed_radius_m(), config.max_side_cells,
                    config.keep_out, settler()),
        far_(config.cell_m, config.known_map),
        poses_(config.body, settler()),
        keep_out_(config.keep_out ? config.keep_out->view() : KeepOut{}) {
    for (Answer& answer : answers_) {
      answer = std::make_unique<Result>(config.max_side_cells);
      answer->psi = pass_.take_psi();
    }
  }

  void submit(const PlanRequest& request) noexcept override {
    const PlanClock begin(*executor_);
    Result& result = *answers_[1];
    Plan& plan = result.plan;
    plan.stamp = request.stamp;
    plan.sequence = ++submissions_;
    plan.certified = false;
    plan.reach = 0.0F;
    plan.cycles = 0;
    plan.path.clear();
    plan.predictions.clear();
    plan.guide = {};
    plan.poses = {};
    result.by_potential = request.wants_potential;
    plan.status = answer(request, result);
    if (plan.status != PlanStatus::kOk) plan.path.clear();
    plan.took = PlanClock(*executor_) - begin;
    is_new_ = true;
  }

  [[nodiscard]] const Plan& collect() noexcept override {
    if (is_new_) std::swap(answers_[0], answers_[1]);
    is_new_ = false;
    return answers_[0]->plan;
  }

  [[nodiscard]] FieldView view_field() const override {
    const Result& shown = *answers_[0];
    const auto cells = static_cast<std::size_t>(shown.window.grid().cells());
    if (!shown.by_potential) time_to_go_.draw(shown.plan.guide, shown.psi);
    return {.of = shown.by_potential ? FieldView::Of::kPotential : FieldView::Of::kTimeToGo,
            .low = shown.window.low,
            .width = shown.window.side,
            .height = shown.window.side,
            .cell_m = config_.cell_m,
            .psi = {shown.psi, cells}};
  }

  [[nodiscard]] const char* backend() const noexcept override { return executor_->name(); }
  [[nodiscard]] const char* failure() const noexcept override {
    if constexpr (requires { executor_->failure(); }) return executor_->failure();
    return "";
  }

  /// What the stages of the last submission left behind. For tests.
  [[nodiscard]] const FieldArrays& arrays() const noexcept { return pass_.arrays(); }
  [[nodiscard]] const Window& window() const noexcept { return window_.now(); }

 private:
  struct Result {
    Plan plan;
    Window window;
    TimeToGoField::Memory time_to_go;
    PoseField::Memory poses;
    float* psi = nullptr;
    bool by_potential = true;

    explicit Result(std::int32_t max_side) : time_to_go(max_side) {}
  };
  using Answer = std::unique_ptr<Result>;

  [[nodiscard]] TimeToGoRequest time_to_go_request(const PlanRequest& request, const Result& result) noexcept {
    const Vec2 robot = request.map_from_robot.position();
    const bool is_far = !result.window.holds(request.goal_in_map, 0);
    if (is_far) far_.settle(request.stamp, request.still, robot, request.goal_in_map);
    return {.window = result.window,
            .still = request.still,
            .movers = request.masked,
            .robot_in_map = robot,
            .goal_in_map = request.goal_in_map,
            .speed_mps = request.speed_mps,
            .far = is_far ? &far_ : nullptr};
  }

  [[nodiscard]] std::int32_t cells(double metres) const noexcept {
    return static_cast<std::int32_t>(std::floor(metres / config_.cell_m + 0.5));
  }
  [[nodiscard]] float inflation() const noexcept { return static_cast<float>(config_.inflation_m / config_.cell_m); }

  [[nodiscard]] bool is_free(std::int32_t c) const noexcept { return pass_.shown().clearance[c] > 0.0F; }

  /// The free cell nearest the robot, within kStartRadius_m.
  [[nodiscard]] std::int32_t nearest_free(CellIndex robot) const noexcept {
    return nearest_cell(window().grid(), robot.i, robot.j, cells(kStartRadius_m),
                        [this](std::int32_t c) { return is_free(c); });
  }

  [[nodiscard]] CostSettler* settler() noexcept {
    if constexpr (requires { executor_->settler(); }) return executor_->settler();
    return nullptr;
  }
  [[nodiscard]] bool has_failed() const noexcept {
    if constexpr (requires { executor_->has_failed(); }) return executor_->has_failed();
    return false;
  }
  [[nodiscard]] bool is_ready() noexcept {
    if constexpr (requires { executor_->is_ready(); }) return executor_->is_ready();
    return true;
  }

  /// What a device that failed has not settled is settled here; the failure is told all the same.
  PlanStatus answer(const PlanRequest& request, Result& result) noexcept {
    if (!is_ready()) return PlanStatus::kBackendFailed;
    const PlanStatus status = plan(request, result);
    return has_failed() ? PlanStatus::kBackendFailed : status;
  }

  PlanStatus plan(const PlanRequest& request, Result& result) noexcept {
    if (!is_finite(request)) return PlanStatus::kBadRequest;
    window_.place(request.map_from_robot.position(), request.goal_in_map);
    result.window = window();
    if (!request.wants_potential) return plan_by_time_to_go(request, result);
    const PlanStatus status = plan_by_potential(request, result);
    if (status != PlanStatus::kBackendFailed) settle_time_to_go(request, time_to_go_request(request, result), result);
    return status;
  }

  void settle_time_to_go(const PlanRequest& request, const TimeToGoRequest& asked, Result& result) noexcept {
    const Guide& guide = result.plan.guide = time_to_go_.settle(asked, result.time_to_go);
    if (!request.poses.is_asked) return;
    result.plan.poses = poses_.settle({.guide = guide,
                                       .map_from_robot = request.map_from_robot,
                                       .goal_in_map = request.goal_in_map,
                                       .movers = request.masked,
                                       .asked = request.poses},
                                      result.poses);
  }

  PlanStatus plan_by_time_to_go(const PlanRequest& request, Result& result) noexcept {
    const TimeToGoRequest asked = time_to_go_request(request, result);
    settle_time_to_go(request, asked, result);
    result.plan.certified = time_to_go_.is_certified();
    result.plan.reach = result.plan.certified ? 1.0F : 0.0F;
    const TimeToGoPath path(time_to_go_, asked);
    const PlanStatus status = path.status();
    if (status == PlanStatus::kOk) path.draw(result.plan.path);
    window_.note_walled_off(status == PlanStatus::kNoPath && window_.can_grow() && path.is_walled_off(flood_));
    return status;
  }

  PlanStatus plan_by_potential(const PlanRequest& request, Result& result) noexcept {
    std::fill_n(result.psi, window().grid().cells(), cell::kNotFree);
    const std::int32_t movers = fetch_movers(window(), request.moving, pass_.shown().movers, mover_ids_);
    Warping warping = warping_for(config_, window(), request);
    PlanStatus status = plan_among(request, warping, movers, result);
    const bool may_leave = movers > 0 || !request.standing.empty();
    if (status == PlanStatus::kNoPath && may_leave && config_.mode == PlanMode::kFull) {
      // They may have left what they block by the time the robot comes there: beyond the horizon they do not count.
      warping.reach = warping.robot_speed * warping.cap_s;
      status = plan_among(request, warping, movers, result);
    }
    if (status == PlanStatus::kNoPath) {
      consider_growing(request);
    } else {
      window_.note_walled_off(false);
    }
    return status;
  }

  PlanStatus plan_among(const PlanRequest& request, const Warping& warping, std::int32_t movers,
                        Result& result) noexcept {
    const Grid grid = window().grid();
    fetch_walls(window(), request.still, pass_.shown().occupants);
    fetch_keep_out(window(), keep_out_, request.map_from_robot.position(), pass_.shown().occupants);
    fetch_standing(window(), request, warping.reach, pass_.shown().occupants);
    if (!pass_.mark_and_clear(grid, warping, movers, inflation(), kWall | kMover)) return PlanStatus::kBackendFailed;
    report_predictions(movers, result.plan);
    const CellIndex robot = window().cell_at(request.map_from_robot.position());
    if (nearest_free(robot) == kNoCell) return PlanStatus::kRobotBlocked;
    const std::int32_t goal = choose_goal(request, robot);
    return goal == kNoCell ? PlanStatus::kNoPath : descend(request, robot, goal, result);
  }

  void report_predictions(std::int32_t movers, Plan& plan) const noexcept {
    plan.predictions.clear();
    for (std::int32_t k = 0; k < movers; ++k) {
      const Mark& mark = pass_.shown().marks[k];
      (void)plan.predictions.push_back(
          {.track_id = mover_ids_[static_cast<std::size_t>(k)],
           .position_in_map = window().in_map({static_cast<double>(mark.x), static_cast<double>(mark.y)}),
           .mark_radius_m = static_cast<double>(mark.radius) * config_.cell_m,
           .horizon_s = static_cast<double>(mark.horizon_s)});
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
    const double radius = has_mover_near(wanted) ? kGoalRadiusBesideMover_m : kGoalRadius_m;
    return nearest_cell(grid, wanted.i, wanted.j, cells(radius), [this](std::int32_t c) { return flood_.holds(c); });
  }

  /// Whether a mover's mark keeps this cell from being free.
  [[nodiscard]] bool has_mover_near(CellIndex at) const noexcept {
    return nearest_cell(window().grid(), at.i, at.j, cells(config_.inflation_m),
                        [this](std::int32_t c) { return (pass_.shown().occupants[c] & kMover) != 0; }) != kNoCell;
  }

  /// Field, index matrix, band and path to a free goal cell.
  PlanStatus descend(const PlanRequest& request, CellIndex robot, std::int32_t goal, Result& result) noexcept {
    const ShownArrays& a = pass_.shown();
    const Grid grid = window().grid();
    const bool warm = solved_goal_ == goal && solved_window_ == window();
    const Disc near{robot.i, robot.j, cells(kStartRadius_m)};
    const FieldQuality quality = pass_.solve(grid, goal, warm ? From::kLast : From::kNothing, near, result.psi);
    if (!quality.done) return PlanStatus::kBackendFailed;
    if (quality.joined == 0) return PlanStatus::kNoPath;
    const std::int32_t start =
        nearest_cell(grid, near.i, near.j, near.radius, [&](std::int32_t c) { return cell::is_joined(result.psi[c]); });
    solved_goal_ = goal;
    solved_window_ = window();
    result.plan.certified = quality.certified;
    result.plan.cycles = quality.cycles;
    // Nothing reads the occupants any more: room for the count.
    result.plan.reach = quality.certified ? 1.0F : share_arriving(grid, result.psi, a.index, goal, a.occupants);
    return draw(request, grid.at(robot.i, robot.j) == start, start, goal, result.plan.path);
  }

  /// The raw path, pulled taut and resampled. A robot in its own cell stands for that cell; one that first has to
  /// leave an obstacle's inflation goes straight to the start cell, and that leg is not pulled.
  PlanStatus draw(const PlanRequest& request, bool starts_free, std::int32_t start, std::int32_t goal,
                  Path& path) noexcept {
    const ShownArrays& a = pass_.shown();
    const Vec2 from = request.map_from_robot.position();
    const Vec2 robot = window().in_cells(from);
    const std::int32_t fixed = starts_free ? 0 : 1;  // points before the start cell's
    const std::int32_t count = follow(window().grid(), a.index, start, goal, {a.points, kMaxBandPoints}, fixed);
    if (count == 0) return PlanStatus::kNoPath;
    a.points[0] = {static_cast<float>(robot.x), static_cast<float>(robot.y)};
    const CellIndex wanted = window().cell_at(request.goal_in_map);
    const bool at_true_goal = window().holds(request.goal_in_map, 0) && window().grid().at(wanted.i, wanted.j) == goal;
    const cell::Point last = a.points[count - 1];
    const Vec2 end = at_true_goal ? request.goal_in_map
                                  : window().in_map({static_cast<double>(last.x), static_cast<double>(last.y)});
    if (at_true_goal && count > 1) {
      const Vec2 there = window().in_cells(end);
      a.points[count - 1] = {static_cast<float>(there.x), static_cast<float>(there.y)};
    }
    if (!pass_.pull(window().grid(), fixed + 1, count)) return PlanStatus::kBackendFailed;
    resample(window(), a.clearance, {a.points, static_cast<std::size_t>(count)}, from, end, path);
    return PlanStatus::kOk;
  }

  /// Of walls alone: movers go away.
  void consider_growing(const PlanRequest& request) noexcept {
    const Grid grid = window().grid();
    if (!window_.can_grow() || !pass_.clear(grid, inflation(), kWall)) return;
    const std::int32_t start = nearest_free(window().cell_at(request.map_from_robot.position()));
    if (start == kNoCell) return;
    fill_from(start);
    const CellIndex goal = window().cell_at(request.goal_in_map);
    window_.note_walled_off(flood_.touches_border() && window().holds(request.goal_in_map, 0) &&
                            nearest_cell(grid, goal.i, goal.j, cells(kGoalRadius_m),
                                         [this](std::int32_t c) { return flood_.holds(c); }) == kNoCell);
  }

  void fill_from(std::int32_t free_cell) noexcept {
    flood_.fill(window().grid(), free_cell, false, [this](std::int32_t c) { return is_free(c); });
  }

  PlannerConfig config_;
  std::unique_ptr<Executor> executor_;
  Pass<Executor> pass_;
  Flood flood_;
  GrowingWindow window_;
  Window solved_window_;  ///< that the potential was last solved on, and for which goal cell
  std::int32_t solved_goal_ = kNoCell;
  TimeToGoField time_to_go_;
  FarGuide far_;
  PoseField poses_;
  KeepOut keep_out_;
  std::array<std::uint32_t, kMaxTracks> mover_ids_{};
  std::array<Answer, 2> answers_;  ///< collected, and being made
  bool is_new_ = false;
  std::uint32_t submissions_ = 0;
};

}  // namespace jaywalk::field
