#pragma once
// A goal or a place as others publish it: geometry_msgs/PoseStamped, PoseWithCovarianceStamped.
#include <optional>
#include <string>
#include <string_view>

#include "apps/view/view_orders.h"

namespace jaywalk::view {

/// In CDR. Nothing where it is none, its frame is neither "map" nor empty, or its rotation no turn in
/// the plane. A rotation of four zeros wishes no heading.
[[nodiscard]] std::optional<GoalOrder> goal_from_cdr(std::string_view message);
/// The same as JSON: {"header":{"frame_id":"map"},"pose":{"position":{"x":..},"orientation":{"z":..,"w":..}}}.
[[nodiscard]] std::optional<GoalOrder> goal_from_json(std::string_view message);

/// As the live page says it: {"goal":[x,y]} or {"goal":[x,y,heading]}; `name`: "goal" or "here".
[[nodiscard]] std::string words_of(const GoalOrder& goal, const char* name = "goal");

}  // namespace jaywalk::view
