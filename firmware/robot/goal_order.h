#pragma once
#include <span>
#include <string>
#include <string_view>

#include "hal/types/fixed_vector.h"
#include "hal/types/operator_input.h"

namespace jaywalk {

/// Where an operator tells a robot to go.
struct GoalOrder {
  Vec2 position_in_map;
  double heading_rad = kAnyHeading;  ///< in (-pi, pi]; NaN: any
};

/// From "X Y" or "X Y HEADING", separated by spaces; metres, radians, at most a turn either way. Throws StartupError
/// "goto: cause; remedy" for anything else. Not for the loop.
[[nodiscard]] GoalOrder read_goal_order(std::string_view words);

/// A place that has a name in the robot file.
struct NamedPlace {
  std::string name;
  GoalOrder order;
};

/// Goals one after the other; at most 16, as many as a person gives in one line.
using Route = FixedVector<GoalOrder, 16>;

/// Whether a word may be a place's name and is no number: names begin with a letter. Only names make a route; one name
/// among numbers is a number mistyped.
[[nodiscard]] bool is_place_name(std::string_view word);

/// From "X Y", "X Y HEADING", or names of `places` in the order to go there, separated by spaces. Throws StartupError
/// "goto: cause; remedy" for anything else. Not for the loop.
[[nodiscard]] Route read_route(std::string_view words, std::span<const NamedPlace> places);

/// Its words: read_goal_order() gives the same order.
[[nodiscard]] std::string words_of(const GoalOrder& order);

}  // namespace jaywalk
