#pragma once
#include <limits>
#include <vector>

#include "planner/cost_to_go/planner.h"

namespace jaywalk::faults {

/// What the bench does to plans.
enum class PlanFault { kNone, kNoMore, kNotFinite };

/// Plans a straight line to the goal, a point every decimetre. The matrix measures what stops a robot, in a hall where
/// nothing is in the way; the grid planner would answer the same at a hundred times the price.
class StraightPlanner final : public Planner {
 public:
  void submit(const PlanRequest& request) noexcept override {
    if (fault_ == PlanFault::kNoMore) return;
    plan_.stamp = request.stamp;
    ++plan_.sequence;
    plan_.status = PlanStatus::kOk;
    plan_.path.clear();
    const Vec2 from = request.map_from_robot.position(), way = request.goal_in_map - from;
    const double length = norm(way);
    for (double gone = 0.0; gone < length; gone += kStep_m) add(from + way * (gone / length));
    add(request.goal_in_map);
    plan_.guide = guide_to(request);
  }
  [[nodiscard]] const Plan& collect() noexcept override { return plan_; }
  [[nodiscard]] FieldView view_field() const override { return {}; }
  [[nodiscard]] const char* backend() const noexcept override { return "straight"; }
  void order(PlanFault fault) noexcept { fault_ = fault; }

 private:
  static constexpr double kStep_m = 0.1;
  static constexpr std::int32_t kSide = 96;  ///< cells of a metre, with the goal in the middle

  /// Nothing stands anywhere, and the way is straight.
  [[nodiscard]] Guide guide_to(const PlanRequest& request) noexcept {
    const auto low_x = static_cast<float>(request.goal_in_map.x) - kSide / 2,
               low_y = static_cast<float>(request.goal_in_map.y) - kSide / 2;
    for (std::int32_t j = 0; j < kSide; ++j) {
      for (std::int32_t i = 0; i < kSide; ++i) {
        const double away = norm({i + 0.5 - kSide / 2, j + 0.5 - kSide / 2}) / request.speed_mps;
        to_go_s_[static_cast<std::size_t>(j * kSide + i)] =
            fault_ == PlanFault::kNotFinite ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(away);
      }
    }
    return {low_x, low_y, 1.0F, kSide, false, surface_.data(), unseen_.data(), to_go_s_.data()};
  }

  void add(Vec2 point) noexcept {
    if (fault_ == PlanFault::kNotFinite) point.y = std::numeric_limits<double>::quiet_NaN();
    static_cast<void>(plan_.path.push_back(point));  // of 4096: the hall has room for 440
  }

  static constexpr std::size_t kCells = static_cast<std::size_t>(kSide) * kSide;
  std::vector<Place> surface_ = std::vector<Place>(kCells, Place{1e9F, 1e9F});
  std::vector<std::uint8_t> unseen_ = std::vector<std::uint8_t>(kCells, 0);
  std::vector<float> to_go_s_ = std::vector<float>(kCells, 0.0F);
  Plan plan_;
  PlanFault fault_ = PlanFault::kNone;
};

}  // namespace jaywalk::faults
