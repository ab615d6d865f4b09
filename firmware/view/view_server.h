#pragma once
// Serves the live page and its WebSocket from a thread of its own.
#include <atomic>
#include <cstdint>
#include <functional>
#include <list>
#include <string>
#include <thread>

#include "firmware/robot/ring.h"
#include "firmware/view/view_client.h"

namespace jaywalk::view {

struct ViewAddress {
  std::string address = "127.0.0.1";  ///< IPv4; any other than 127.0.0.1 asks for a token in the page's address
  std::uint16_t port = 0;             ///< 0: any that is free
};

enum class MessageKind : std::uint8_t {
  kHello,  ///< said to everybody who joins later, too
  kField,  ///< the same
  kFrame   ///< of this moment
};

struct ViewMessage {
  MessageKind kind = MessageKind::kFrame;
  std::string text;  ///< JSON
};

/// Thread: push() belongs to one thread, everything else happens on the server's own. push() never waits: where the
/// ring is full, the message is left out; where a client does not read, that client's are.
class ViewServer {
 public:
  /// Throws StartupError where the address is none or the port is taken.
  ViewServer(const ViewAddress& where, std::function<void(std::string_view)> on_order);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  void push(MessageKind kind, std::string text);
  /// What to type into a browser; with the token where one is wanted.
  [[nodiscard]] std::string url() const;
  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }

 private:
  void run();
  void accept_newcomers();
  void pass_on();
  void serve_clients();

  ViewRules rules_;
  std::string address_;
  std::uint16_t port_ = 0;
  wire::FileDescriptor listener_;
  Ring<ViewMessage, 16> ring_;
  std::list<ViewClient> clients_;
  std::string hello_, field_;
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace jaywalk::view
