#pragma once
#include <optional>

#include "apps/view/view_orders.h"
#include "hal/hal.h"

namespace jaywalk::view {

/// An operator's panel whose goal the live page may replace. Without an order it is the other panel, bit for bit.
/// Thread: the loop's.
class SteeredPanel final : public OperatorPanel {
 public:
  explicit SteeredPanel(OperatorPanel& inner) : inner_(inner) {}
  [[nodiscard]] OperatorInput latest() noexcept override {
    OperatorInput input = inner_.latest();
    input.stop_orders += stops_;
    if (stopped_ || goal_) input.steers = false, input.stick = {};
    if (stopped_) input.has_goal = false;
    if (!goal_) return input;
    input.has_goal = true;
    input.goal_in_map = goal_->goal_in_map;
    input.goal_heading_rad = goal_->heading_rad;
    return input;
  }
  /// Between ticks.
  void obey(const ViewOrder& order) noexcept {
    if (order.goal) goal_ = order.goal, stopped_ = false;
    if (order.stop) goal_.reset(), stopped_ = true, ++stops_;
  }

 private:
  OperatorPanel& inner_;
  std::optional<GoalOrder> goal_;
  bool stopped_ = false;
  std::uint32_t stops_ = 0;
};

}  // namespace jaywalk::view
