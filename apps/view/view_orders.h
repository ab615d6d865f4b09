#pragma once
// Orders of a person on the live page, or of other programs' goal messages, on their way to whatever drives.
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "firmware/robot/goal_order.h"
#include "hal/hal.h"

namespace jaywalk::view {
/// One order; fields that are empty were not asked for.
struct ViewOrder {
  std::optional<GoalOrder> goal;
  std::optional<GoalOrder> here;  ///< where the robot is
  std::optional<bool> pause;
  bool stop = false;
  bool reset = false;
  bool step = false;
  // Orders to an endless world (jaywalk sim --endless).
  std::optional<std::size_t> fault;  ///< number of the fault to begin, in the hello's list
  int walkers = 0;                   ///< number of walkers to add; negative: to remove
  std::optional<double> pace;        ///< simulated seconds a second
  [[nodiscard]] bool plays() const noexcept { return fault || walkers != 0 || pace; }
};

/// {"goal":[x,y]}, {"goal":[x,y,heading]}, {"here":[x,y,heading]}, {"stop":true}, {"reset":true}, {"pause":true},
/// {"step":true}, {"fault":N}, {"walkers":1}, {"pace":2}; m and rad in the map. Nothing where it is none of these or a
/// number is no place (beyond 1e6 m) or no angle (beyond pi).
[[nodiscard]] std::optional<ViewOrder> parse_order(std::string_view json);

/// Orders wait here until they are taken; a later one of a kind replaces the earlier, and a stop takes back the goal
/// and the reset before it. Any thread.
class ViewOrders {
 public:
  void add(const ViewOrder& order);
  [[nodiscard]] ViewOrder take();

 private:
  std::mutex mutex_;
  ViewOrder waiting_;
};

/// In CDR. Nothing where it is none, its frame is neither "map" nor empty, or its rotation no turn in
/// the plane. A rotation of four zeros wishes no heading.
[[nodiscard]] std::optional<GoalOrder> goal_from_cdr(std::string_view message);
/// The same as JSON: {"header":{"frame_id":"map"},"pose":{"position":{"x":..},"orientation":{"z":..,"w":..}}}.
[[nodiscard]] std::optional<GoalOrder> goal_from_json(std::string_view message);

/// As parse_order() reads it; `name`: "goal" or "here".
[[nodiscard]] std::string to_json(const GoalOrder& goal, const char* name = "goal");

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
    input.goal_in_map = goal_.position_in_map;
    input.goal_heading_rad = goal_.heading_rad;
    return input;
  }
  /// Between ticks.
  void obey(const ViewOrder& order, bool at_rest) noexcept {
    if (order.stop) has_goal_ = false, pressed_ = true, ++stops_;
    if (order.reset && !order.stop && at_rest) resets_ = true, pressed_ = false;
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
