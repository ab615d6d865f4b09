#include "apps/view/foxglove_session.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/formats/ros_topics.h"
#include "apps/formats/wire_reader.h"
#include "apps/view/view_orders.h"

namespace jaywalk::view {
namespace {
using Json = nlohmann::json;

// Opcodes of binary frames.
constexpr char kMessageData = 1;  ///< either way
constexpr char kTime = 2, kServiceCall = 2, kServiceAnswer = 3;
constexpr std::size_t kCallHead = 13;  ///< opcode, service, call, letters of its encoding
constexpr std::size_t kMostNumbers = 64;
constexpr std::size_t kMostShown = 40;  ///< letters of what a client said
constexpr int kWarning = 1;

std::string dumped(const Json& json) { return json.dump(-1, ' ', true, Json::error_handler_t::replace); }

std::string status(const std::string& said, int level = kWarning) {
  return dumped({{"op", "status"}, {"level", level}, {"message", said}});
}

FoxgloveSession::Outcome warned(const std::string& said) { return {.order = "", .status = status(said)}; }

std::string nanoseconds(Time stamp) {
  return exchange::raw(std::max<std::int64_t>(stamp.time_since_epoch().count(), 0));
}

/// Null where `json` has none of that name.
Json member(const Json& json, const char* key) { return json.contains(key) ? json[key] : Json(); }

/// A whole number that fits; nothing otherwise.
std::optional<std::uint32_t> id_in(const Json& json, const char* key) {
  const Json id = member(json, key);
  return id.is_number_unsigned() && id <= UINT32_MAX ? std::optional(id.get<std::uint32_t>()) : std::nullopt;
}

std::string text_in(const Json& json, const char* key) {
  const Json text = member(json, key);
  return text.is_string() ? text.get<std::string>() : "";
}

/// The list under `key`; an empty one where there is none.
Json list_in(const Json& json, const char* key) {
  const Json list = member(json, key);
  return list.is_array() ? list : Json::array();
}

/// Answers with the parameters that are named, or with all: what was to be set shows its old value again.
std::string values(std::span<const FoxgloveParameter> parameters, const Json& asked) {
  const Json names = list_in(asked, "parameterNames");
  Json listed = Json::array();
  for (const auto& [name, value] : parameters) {
    if (names.empty() || std::find(names.begin(), names.end(), Json(name)) != names.end())
      listed.push_back({{"name", name}, {"type", "float64"}, {"value", value}});
  }
  Json answer{{"op", "parameterValues"}, {"parameters", listed}};
  if (asked.contains("id")) answer["id"] = text_in(asked, "id");
  return dumped(answer);
}

Json message_type(const char* name, const char* schema) {
  return {{"encoding", "cdr"}, {"schemaName", name}, {"schemaEncoding", "ros2msg"}, {"schema", schema}};
}

Json stop_service() {
  return {{"id", 0},
          {"name", "/stop"},
          {"type", "std_srvs/srv/Trigger"},
          {"request", message_type("std_srvs/srv/Trigger_Request", "")},
          {"response", message_type("std_srvs/srv/Trigger_Response", "bool success\nstring message\n")}};
}

/// Number of four bytes from byte `at` on, which the payload must have.
std::uint32_t u32_at(std::string_view payload, std::size_t at) {
  return exchange::WireReader(payload.substr(at)).u32();
}

/// The only service, 0, is /stop, whatever its request holds.
FoxgloveSession::Outcome called(std::string_view payload) {
  if (payload.size() < kCallHead || u32_at(payload, 1) != 0) return warned("no such service");
  const std::size_t letters = u32_at(payload, kCallHead - 4);
  const std::string_view encoding = payload.substr(kCallHead).substr(0, letters);
  if (encoding != "cdr" && encoding != "json") return warned("a call is in cdr or json");
  return {.order = R"({"stop":true})", .status = "", .call = std::string(payload.substr(0, kCallHead + letters))};
}

}  // namespace

std::string foxglove_subprotocol(std::string offered) {
  std::erase(offered, ' ');
  for (const std::string spoken : {"foxglove.sdk.v1", "foxglove.websocket.v1"})
    if (("," + offered + ",").find("," + spoken + ",") != std::string::npos) return spoken;
  return "";
}

std::vector<std::string> foxglove_greeting(std::span<const FoxgloveChannel> channels) {
  Json listed = Json::array();
  for (std::size_t k = 0; k < channels.size(); ++k) {
    listed.push_back({{"id", k},
                      {"topic", channels[k].topic},
                      {"encoding", "cdr"},
                      {"schemaName", channels[k].type},
                      {"schemaEncoding", "ros2msg"},
                      {"schema", channels[k].schema}});
  }
  return {dumped({{"op", "serverInfo"},
                  {"name", "jaywalk"},
                  {"capabilities", {"clientPublish", "parameters", "services", "time"}},
                  {"supportedEncodings", {"cdr", "json"}},
                  {"metadata", Json::object()}}),
          dumped({{"op", "advertise"}, {"channels", listed}}),
          dumped({{"op", "advertiseServices"}, {"services", {stop_service()}}})};
}

std::string foxglove_answer(std::string_view said) {
  const std::string text = text_in(Json::parse(said, nullptr, false), "text");
  return status(text, text.starts_with("refused") ? kWarning : 0);
}

std::string foxglove_service_answer(std::string_view call, std::string_view said) {
  const std::string text = text_in(Json::parse(said, nullptr, false), "text");
  const bool stops = !text.starts_with("refused");
  exchange::CdrWriter cdr;
  cdr.u8(stops ? 1 : 0).text(text);
  std::string frame(call);
  frame[0] = kServiceAnswer;
  return frame + (call.ends_with("json") ? dumped({{"success", stops}, {"message", text}}) : cdr.message());
}

FoxgloveSession::Outcome FoxgloveSession::take_text(std::string_view text) {
  Outcome outcome;
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return warned("no JSON object");
  const std::string op = text_in(json, "op");
  if (op == "subscribe") {
    for (const Json& wish : list_in(json, "subscriptions")) {
      const auto id = id_in(wish, "id"), channel = id_in(wish, "channelId");
      if (!id || !channel || *channel >= channels_) {
        outcome.status = status("a subscription names no channel");
      } else if (!subscriptions_.emplace(*channel, *id).second) {
        outcome.status = status("a channel is subscribed to already");
      } else {
        outcome.subscribed.push_back(*channel);
      }
    }
  } else if (op == "unsubscribe") {
    for (const Json& id : list_in(json, "subscriptionIds"))
      std::erase_if(subscriptions_, [&id](const auto& one) { return id.is_number_unsigned() && id == one.second; });
  } else if (op == "advertise") {
    for (const Json& channel : list_in(json, "channels"))
      if (const auto id = id_in(channel, "id"); id && published_.size() < kMostNumbers)
        published_[*id] = {text_in(channel, "topic"), text_in(channel, "encoding")};
  } else if (op == "unadvertise") {
    for (const Json& id : list_in(json, "channelIds"))
      if (id.is_number_unsigned()) published_.erase(id.get<std::uint32_t>());
  } else if (op == "getParameters" || op == "setParameters") {
    outcome.status = values(parameters_, json);
  } else {
    outcome.status = status("not served: " + op.substr(0, kMostShown));
  }
  return outcome;
}

FoxgloveSession::Outcome FoxgloveSession::take_binary(std::string_view payload) {
  constexpr std::size_t kHead = 5;
  if (payload.starts_with(kServiceCall)) return called(payload);
  if (payload.size() < kHead || payload[0] != kMessageData) return warned("no client message");
  const auto found = published_.find(u32_at(payload, 1));
  if (found == published_.end()) return warned("a message of a channel that is not advertised");
  const auto& [topic, encoding] = found->second;
  const bool is_place = topic == "/initialpose";
  if (topic != "/goal_pose" && !is_place)
    return warned(topic.substr(0, kMostShown) + " is not taken: publish /goal_pose or /initialpose");
  const auto pose = encoding == "json" ? goal_from_json(payload.substr(kHead)) : goal_from_cdr(payload.substr(kHead));
  if (!pose) return warned(topic + ": no pose in the plane of the frame map");
  return {.order = to_json(*pose, is_place ? "here" : "goal"), .status = ""};
}

std::optional<std::uint32_t> FoxgloveSession::subscription(std::size_t channel) const {
  const auto found = subscriptions_.find(channel);
  return found == subscriptions_.end() ? std::nullopt : std::optional(found->second);
}

std::uint32_t FoxgloveSession::wanted() const {
  std::uint32_t bits = 0;
  for (const auto& [channel, id] : subscriptions_) bits |= 1U << channel;
  return bits;
}

std::string foxglove_head(std::uint32_t subscription, Time stamp) {
  return kMessageData + exchange::raw(subscription) + nanoseconds(stamp);
}

std::string foxglove_time(Time now) { return kTime + nanoseconds(now); }

FoxgloveChannel joint_channel() {
  // Another type that has a header and no other message in it brings the header's definition.
  const std::string like = exchange::ros_schema("sensor_msgs/msg/CompressedImage");
  return {"/joint_states", "sensor_msgs/msg/JointState",
          "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n" +
              like.substr(like.find("===="))};
}

std::string joint_states(const WheelState& wheels, Time now) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const std::int64_t ns = now.time_since_epoch().count();
  exchange::CdrWriter out;
  out.i32(ns / kSecond).u32(static_cast<std::size_t>(ns % kSecond)).text("");
  out.u32(2).text("left_wheel_joint").text("right_wheel_joint");
  out.u32(2).f64(wheels.left_rad).f64(wheels.right_rad);
  out.u32(2).f64(wheels.left_radps).f64(wheels.right_radps).u32(0);
  return out.message();
}

}  // namespace jaywalk::view
