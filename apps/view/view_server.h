#pragma once
// Serves the live page and its WebSocket from a thread of its own.
#include <atomic>
#include <cstdint>
#include <functional>
#include <list>
#include <string>
#include <thread>
#include <vector>

#include "apps/view/view_client.h"
#include "firmware/robot/ring.h"

namespace jaywalk::view {

struct ViewAddress {
  std::string address = "127.0.0.1";  ///< IPv4; any other than 127.0.0.1 asks for a token in the page's address
  std::uint16_t port = 0;             ///< 0: any that is free
  std::string origin;                 ///< one more site whose pages may open a WebSocket, such as https://example.org
};

/// Whom the server asks. Both are called on its thread.
struct ViewDoor {
  /// A JSON text of the page's, or a goal of Foxglove's as such; the answer goes to that client alone, empty: none.
  std::function<std::string(std::string_view)> on_order;
  std::vector<FoxgloveChannel> channels = {};  ///< at most 32; numbered from 0
};

enum class MessageKind : std::uint8_t {
  kHello,  ///< also sent to clients that join later
  kField,  ///< the same
  kFrame,  ///< of this moment
  kEnd,    ///< a run's last frame: said to everybody, however slow
  kTopic   ///< a message of a Foxglove channel
};

struct ViewMessage {
  MessageKind kind = MessageKind::kFrame;
  std::string text;  ///< JSON; of a topic: CDR
  std::size_t channel = 0;
  Time stamp = kNever;
};

/// Thread: push() belongs to one thread, everything else happens on the server's own. push() never waits: where the
/// ring is full, the message is left out; where a client does not read, that client's are.
class ViewServer {
 public:
  /// Throws StartupError where the address is none or the port is taken.
  ViewServer(const ViewAddress& where, ViewDoor door);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  void push(MessageKind kind, std::string text);
  void push(std::size_t channel, Time stamp, std::string message);
  /// Pages and subscribers that look now.
  [[nodiscard]] int viewers() const noexcept { return viewers_; }
  [[nodiscard]] bool has_pages() const noexcept { return has_pages_; }
  /// A bit a channel that a client subscribes to.
  [[nodiscard]] std::uint32_t wanted() const noexcept { return wanted_; }
  /// What to type into a browser; with the token where one is wanted.
  [[nodiscard]] std::string url() const;
  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }

 private:
  void run();
  void accept_newcomers();
  void pass_on();
  static void hand(const ViewMessage& message, ViewClient& client);
  void serve_clients();
  void welcome(ViewClient& client);
  void count_clients();

  ViewRules rules_;
  std::string address_;
  std::uint16_t port_ = 0;
  wire::FileDescriptor listener_;
  Ring<ViewMessage, 64> ring_;  ///< a tick has ten topics and a frame at most
  std::list<ViewClient> clients_;
  std::string hello_, field_;
  std::vector<ViewMessage> said_;  ///< by each channel, last
  std::atomic<int> viewers_{0};
  std::atomic<bool> has_pages_{false};
  std::atomic<std::uint32_t> wanted_{0};
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace jaywalk::view
