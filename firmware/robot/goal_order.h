#pragma once
#include <string>
#include <string_view>

#include "hal/types/operator_input.h"

namespace jaywalk {

/// Where somebody tells a robot to go.
struct GoalOrder {
  Vec2 position_in_map;
  double heading_rad = kAnyHeading;  ///< in (-pi, pi]; NaN: any
};

/// From "X Y" or "X Y HEADING", separated by spaces; metres, radians, at most a turn either way. Throws StartupError
/// "goto: cause; remedy" for anything else. Not for the loop.
[[nodiscard]] GoalOrder read_goal_order(std::string_view words);

/// Its words: read_goal_order() gives the same order.
[[nodiscard]] std::string words_of(const GoalOrder& order);

}  // namespace jaywalk
