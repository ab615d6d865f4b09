#include "apps/view/view_orders.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

namespace jaywalk::view {
namespace {

using Json = nlohmann::json;

constexpr double kFarthest_m = 1e6;
constexpr double kPi = 3.14159265358979323846;

std::optional<GoalOrder> goal_of(const Json& json) {
  if (!json.is_array() || json.size() < 2 || json.size() > 3) return std::nullopt;
  for (const Json& number : json)
    if (!number.is_number()) return std::nullopt;
  const Vec2 goal{json[0].get<double>(), json[1].get<double>()};
  const bool has_heading = json.size() == 3;
  const double heading = has_heading ? json[2].get<double>() : 0.0;
  if (!(std::fabs(goal.x) <= kFarthest_m && std::fabs(goal.y) <= kFarthest_m && std::fabs(heading) <= kPi))
    return std::nullopt;
  return GoalOrder{.goal_in_map = goal, .heading_rad = has_heading ? heading : kAnyHeading};
}

}  // namespace

std::optional<ViewOrder> parse_order(std::string_view json) {
  const Json parsed = Json::parse(json, nullptr, false);
  if (!parsed.is_object() || parsed.size() != 1) return std::nullopt;
  const auto& [name, value] = *parsed.items().begin();
  ViewOrder order;
  if (name == "goal" || name == "here") {
    const auto pose = (name == "goal" ? order.goal : order.here) = goal_of(value);
    return pose ? std::optional(order) : std::nullopt;
  }
  if (!value.is_boolean()) return std::nullopt;
  if (name == "pause") order.pause = value.get<bool>();
  if (name == "stop") order.stop = value.get<bool>();
  if (name == "reset") order.reset = value.get<bool>();
  if (name == "step") order.step = value.get<bool>();
  return order.pause || order.stop || order.reset || order.step ? std::optional(order) : std::nullopt;
}

void ViewOrders::add(const ViewOrder& order) {
  const std::scoped_lock lock(mutex_);
  if (order.stop) waiting_.stop = true, waiting_.goal.reset(), waiting_.reset = false;
  if (order.goal) waiting_.goal = order.goal;
  waiting_.reset = waiting_.reset || order.reset;
  if (order.pause) waiting_.pause = order.pause;
  waiting_.step = waiting_.step || order.step;
}

ViewOrder ViewOrders::take() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(waiting_, {});
}

}  // namespace jaywalk::view
