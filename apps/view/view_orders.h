#pragma once
// What a person does on the live page, on its way to whatever drives.
#include <mutex>
#include <optional>
#include <string_view>

#include "hal/types/geometry.h"
#include "hal/types/operator_input.h"

namespace jaywalk::view {

struct GoalOrder {
  Vec2 goal_in_map;                  ///< m
  double heading_rad = kAnyHeading;  ///< wanted there; NaN: any
};

/// One order; fields that are empty were not asked for.
struct ViewOrder {
  std::optional<GoalOrder> goal;
  std::optional<GoalOrder> here;  ///< where the robot is
  std::optional<bool> pause;
  bool stop = false;
  bool reset = false;
  bool step = false;
};

/// {"goal":[x,y]}, {"goal":[x,y,heading]}, {"here":[x,y,heading]}, {"stop":true}, {"reset":true}, {"pause":true},
/// {"step":true}; m and rad in the map. Nothing where it is none of these or a number is no place (beyond 1e6 m) or no
/// angle (beyond pi).
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

}  // namespace jaywalk::view
