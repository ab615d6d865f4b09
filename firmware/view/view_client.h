#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "drivers/wire/file_descriptor.h"

namespace jaywalk::view {

/// What a client may have, and how it must ask.
struct ViewRules {
  std::string token;  ///< to be given as ?token=; empty: none is wanted
  bool loopback = true;
  std::function<void(std::string_view)> on_order;  ///< called on the server's thread with one JSON text
};

/// One browser's connection: first HTTP, then, where it asks for /ws, a WebSocket. Nothing waits. Thread: the server's.
class ViewClient {
 public:
  ViewClient(wire::FileDescriptor socket, const ViewRules& rules) : socket_(std::move(socket)), rules_(rules) {}

  /// Reads what came, answers it, and sends what is left. False: the connection is over.
  [[nodiscard]] bool serve();
  /// Sends a message whole, or leaves it out while an earlier one is not yet gone: a slow client loses frames.
  void offer(std::string_view message);
  /// True once, after the upgrade: hello is to be sent.
  [[nodiscard]] bool has_joined() noexcept { return std::exchange(joined_, false); }
  /// The same as offer(), but behind what is unsent: for the few messages that a newcomer needs.
  void queue(std::string_view message);
  [[nodiscard]] int socket() const noexcept { return socket_.get(); }
  [[nodiscard]] bool has_unsent() const noexcept { return !unsent_.empty(); }

 private:
  [[nodiscard]] bool receive();
  [[nodiscard]] bool flush();
  void answer_http();
  void answer_frames();
  void refuse(std::string_view status, std::string_view why);

  wire::FileDescriptor socket_;
  const ViewRules& rules_;
  std::string received_, unsent_;
  bool upgraded_ = false, joined_ = false, ends_ = false;
};

}  // namespace jaywalk::view
