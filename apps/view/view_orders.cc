#include "apps/view/view_orders.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/formats/wire_reader.h"
#include "hal/shown_text.h"
#include "hal/types/trig.h"

namespace jaywalk::view {
namespace {
using Json = nlohmann::json;

constexpr double kFarthest_m = 1e6;
constexpr double kSlowest = 0.1, kFastest = 100.0;  ///< pace

std::optional<GoalOrder> goal_of(const Json& json) {
  if (!json.is_array() || json.size() < 2 || json.size() > 3) return std::nullopt;
  for (const Json& number : json)
    if (!number.is_number()) return std::nullopt;
  const Vec2 goal{json[0].get<double>(), json[1].get<double>()};
  const bool has_heading = json.size() == 3;
  const double heading = has_heading ? json[2].get<double>() : 0.0;
  if (!(std::fabs(goal.x) <= kFarthest_m && std::fabs(goal.y) <= kFarthest_m && std::fabs(heading) <= kPi))
    return std::nullopt;
  return GoalOrder{.position_in_map = goal, .heading_rad = has_heading ? heading : kAnyHeading};
}

constexpr double kUnit = 1e-3;  ///< how far a rotation's length may be from 1

/// `z` and `w` of a rotation about the vertical, `x` and `y` near 0.
std::optional<GoalOrder> goal_at(Vec2 place, const std::array<double, 4>& xyzw) {
  const auto [x, y, z, w] = xyzw;
  const double length = x * x + y * y + z * z + w * w;
  if (length == 0.0) return GoalOrder{.position_in_map = place};
  if (!(std::fabs(length - 1.0) < kUnit && x * x + y * y < kUnit)) return std::nullopt;
  return GoalOrder{.position_in_map = place, .heading_rad = wrap_angle(2.0 * atan2(z, w))};
}

bool is_map(std::string_view frame) { return frame.empty() || frame == "map" || frame == "/map"; }

}  // namespace

std::optional<ViewOrder> parse_order(std::string_view json) {
  const Json parsed = Json::parse(json, nullptr, false);
  if (!parsed.is_object() || parsed.size() != 1) return std::nullopt;
  const std::string& name = parsed.begin().key();
  const Json& value = parsed.begin().value();
  ViewOrder order;
  if (name == "goal" || name == "here") {
    const auto pose = (name == "goal" ? order.goal : order.here) = goal_of(value);
    return pose ? std::optional(order) : std::nullopt;
  }
  if (name == "fault" && value.is_number_unsigned()) order.fault = value.get<std::size_t>();
  if (name == "walkers" && (value == 1 || value == -1)) order.walkers = value.get<int>();
  if (name == "pace" && value.is_number() && value >= kSlowest && value <= kFastest) order.pace = value.get<double>();
  if (order.plays()) return order;
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
  if (order.fault) waiting_.fault = order.fault;
  waiting_.walkers += order.walkers;
  if (order.pace) waiting_.pace = order.pace;
}

ViewOrder ViewOrders::take() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(waiting_, {});
}

std::optional<GoalOrder> goal_from_cdr(std::string_view message) {
  exchange::WireReader reader(message, exchange::Wire::kCdr);
  constexpr std::size_t kStamp = 8;
  reader.skip(kStamp);
  const std::string_view frame = reader.text();
  std::array<double, 7> n{};  // position x y z, rotation x y z w
  for (double& number : n) number = reader.f64();
  if (!reader.ok() || !is_map(frame)) return std::nullopt;
  return goal_at({n[0], n[1]}, {n[3], n[4], n[5], n[6]});
}

std::optional<GoalOrder> goal_from_json(std::string_view message) {
  const Json json = Json::parse(message, nullptr, false);
  using At = Json::json_pointer;
  const At nested("/pose/pose"), frame("/header/frame_id");
  const std::string pose = json.contains(nested) ? nested.to_string() : "/pose";
  if (!json.contains(At(pose + "/position"))) return std::nullopt;
  if (json.contains(frame) && !(json[frame].is_string() && is_map(json[frame].get<std::string>()))) return std::nullopt;
  const auto number = [&](const char* name) {
    const At place(pose + name);
    return json.contains(place) && json[place].is_number() ? json[place].get<double>() : 0.0;
  };
  return goal_at({number("/position/x"), number("/position/y")}, {number("/orientation/x"), number("/orientation/y"),
                                                                  number("/orientation/z"), number("/orientation/w")});
}

std::string to_json(const GoalOrder& goal, const char* name) {
  const std::string heading = std::isnan(goal.heading_rad) ? "" : formatted(",%.9g", goal.heading_rad);
  const Vec2 goal_m = goal.position_in_map;
  return formatted(R"({"%s":[%.9g,%.9g%s]})", name, goal_m.x, goal_m.y, heading.c_str());
}

}  // namespace jaywalk::view
