#pragma once
// The client's end of foxglove.websocket.v1 (github.com/foxglove/ws-protocol, docs/spec.md) over a WebSocket (RFC
// 6455).
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "drivers/wire/file_descriptor.h"

namespace jaywalk::dds {

struct FoxgloveMessage {
  std::string topic;
  std::string bytes;  ///< CDR, behind its encapsulation header
};

/// A live view of a run, from another process. Thread: one.
class FoxgloveClient {
 public:
  /// `url` as `jaywalk ... --view` prints it: http://ADDRESS:PORT/, with ?token= where one is wanted; IPv4. Subscribes
  /// to those of `topics` that the run has. Throws StartupError where nothing answers there as it should.
  FoxgloveClient(const std::string& url, std::set<std::string> topics);

  /// The next message that comes within `wait`. Throws StartupError when the run has ended or the connection is lost.
  [[nodiscard]] std::optional<FoxgloveMessage> next(std::chrono::milliseconds wait);
  /// geometry_msgs/PoseStamped in CDR.
  void publish_goal(std::string_view message);

 private:
  void send(std::uint8_t opcode, std::string_view payload);
  void send_all(std::string_view bytes);
  void receive(std::chrono::milliseconds wait);
  /// A whole frame's opcode and payload, where one has come.
  [[nodiscard]] std::optional<std::pair<std::uint8_t, std::string>> take_frame();
  void take_text(const std::string& text);
  [[noreturn]] void lost(const std::string& cause) const;

  std::string url_;
  std::set<std::string> topics_;
  wire::FileDescriptor socket_;
  std::string received_;
  std::map<std::uint32_t, std::string> subscribed_;  ///< topics by their subscription's number
};

}  // namespace jaywalk::dds
