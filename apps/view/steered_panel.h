#pragma once
#include <utility>

#include "apps/view/view_orders.h"
#include "hal/hal.h"

namespace jaywalk::view {

/// Operator panel with the live page's goals in place of its own.
///
/// The page's Stop is an emergency stop. It stays pressed until the page's Reset at rest, and voids the panel's own
/// goal. Without an order the input is the other panel's, bit for bit. Thread: the loop's.
class SteeredPanel final : public OperatorPanel {
 public:
  explicit SteeredPanel(OperatorPanel& inner) : inner_(inner) {}
  [[nodiscard]] OperatorInput latest() noexcept override {
    OperatorInput input = inner_.latest();
    input.stop_orders += stops_;
    input.emergency_stop = input.emergency_stop || pressed_;
    input.reset = input.reset || std::exchange(resets_, false);
    if (stops_ > 0 || has_goal_) input.steers = false, input.stick = {};
    if (stops_ > 0) input.has_goal = false;
    if (!has_goal_) return input;
    input.has_goal = true;
    input.goal_in_map = goal_.goal_in_map;
    input.goal_heading_rad = goal_.heading_rad;
    return input;
  }
  /// Between ticks.
  void obey(const ViewOrder& order, bool at_rest) noexcept {
    if (order.stop) has_goal_ = false, pressed_ = true, ++stops_;
    if (order.reset && !order.stop && at_rest) resets_ = std::exchange(pressed_, false);
    if (order.goal && !pressed_) goal_ = *order.goal, has_goal_ = true;
  }
  [[nodiscard]] bool is_pressed() const noexcept { return pressed_; }

 private:
  OperatorPanel& inner_;
  GoalOrder goal_{};
  bool has_goal_ = false, pressed_ = false, resets_ = false;
  std::uint32_t stops_ = 0;
};

}  // namespace jaywalk::view
