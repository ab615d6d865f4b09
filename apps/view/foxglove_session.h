#pragma once
// The server's end of Foxglove's WebSocket protocol, version 1 (github.com/foxglove/ws-protocol, docs/spec.md):
// channels are advertised, clients subscribe to them, may publish a goal or the robot's place and call /stop.
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/types/wheels.h"

namespace jaywalk::view {
/// A topic that is served: messages in CDR.
struct FoxgloveChannel {
  std::string topic;   ///< "/scan"
  std::string type;    ///< "sensor_msgs/msg/LaserScan"
  std::string schema;  ///< its definition as ROS 2 writes it
};

/// A setting of the robot, read, never set: its name as ROS 2 has a node's ("/jaywalk.max_speed_mps"), its value.
using FoxgloveParameter = std::pair<std::string, double>;

/// The first of a handshake's Sec-WebSocket-Protocol that is spoken here; empty where none is.
[[nodiscard]] std::string foxglove_subprotocol(std::string offered);

/// The texts that a newcomer is sent: serverInfo, an advertisement of all channels, numbered from 0 in this order, and
/// one of the service /stop (std_srvs/srv/Trigger).
[[nodiscard]] std::vector<std::string> foxglove_greeting(std::span<const FoxgloveChannel> channels);

/// One client's subscriptions and what it publishes. Thread: the server's.
class FoxgloveSession {
 public:
  /// `parameters` outlive it.
  explicit FoxgloveSession(std::size_t channels, std::span<const FoxgloveParameter> parameters = {})
      : channels_(channels), parameters_(parameters) {}

  /// What a client's message asks for: an order of the live page's (view_orders.h), or what to tell it.
  struct Outcome {
    std::string order;                      ///< {"goal":[x,y,heading]}, {"here":...}
    std::string status;                     ///< JSON to send back
    std::vector<std::size_t> subscribed{};  ///< channels that begin now
    std::string call{};                     ///< a service's call: what stands before its answer
  };
  [[nodiscard]] Outcome take_text(std::string_view text);
  [[nodiscard]] Outcome take_binary(std::string_view payload);

  /// The client's number for a channel; nothing where it wants none of it.
  [[nodiscard]] std::optional<std::uint32_t> subscription(std::size_t channel) const;
  /// A bit a channel.
  [[nodiscard]] std::uint32_t wanted() const;

 private:
  struct Published {
    std::string topic, encoding;
  };
  std::size_t channels_;
  std::span<const FoxgloveParameter> parameters_;
  std::map<std::size_t, std::uint32_t> subscriptions_;  ///< the client's number of a channel, one each
  std::map<std::uint32_t, Published> published_;        ///< by the client's number
};

/// The status that tells a client what the live page's answer to its order says, {"kind":"said","text":...}.
[[nodiscard]] std::string foxglove_answer(std::string_view said);

/// The binary frame that answers a service's call (Outcome::call) by what the live page's answer says.
[[nodiscard]] std::string foxglove_service_answer(std::string_view call, std::string_view said);

/// What stands before a message in a binary frame of Message Data.
[[nodiscard]] std::string foxglove_head(std::uint32_t subscription, Time stamp);
/// The binary frame that tells the run's clock.
[[nodiscard]] std::string foxglove_time(Time now);

/// /joint_states, by which ROS 2's robot_state_publisher turns a model's wheels: left_wheel_joint and
/// right_wheel_joint, as most models of two-wheeled bases name them.
[[nodiscard]] FoxgloveChannel joint_channel();
/// Its sensor_msgs/JointState in CDR: angles (rad) and speeds (rad/s); no efforts.
[[nodiscard]] std::string joint_states(const WheelState& wheels, Time now);

}  // namespace jaywalk::view
