#pragma once
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/view/foxglove_session.h"
#include "apps/view/websocket.h"
#include "drivers/wire/file_descriptor.h"

namespace jaywalk::view {

/// What a client may have, and how it must ask.
struct ViewRules {
  std::string token;  ///< to be given as ?token=; empty: none is wanted
  bool loopback = true;
  std::string origin;  ///< one more site whose pages may open a WebSocket; empty: none
  /// Called on the server's thread with one JSON text; what it returns is sent to that client.
  std::function<std::string(std::string_view)> on_order;
  std::vector<FoxgloveChannel> channels;  ///< at most 32
};

/// One browser's connection: first HTTP, then a WebSocket of the page's own (/ws) or of Foxglove's (any path). Nothing
/// waits. A connection that says nothing for kIdle, or asks for nothing within kUnasked, is over; a WebSocket is asked
/// by a ping every kPing. Thread: the server's.
class ViewClient {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kIdle{30}, kUnasked{5}, kPing{10};

  ViewClient(wire::FileDescriptor socket, const ViewRules& rules) : socket_(std::move(socket)), rules_(rules) {}

  /// Reads what came, answers it, and sends what is left. False: the connection is over.
  [[nodiscard]] bool serve(Clock::time_point now);
  /// Sends the page's message whole, or leaves it out while an earlier one is not yet gone: a slow client loses frames.
  void offer(std::string_view message);
  /// The same to a subscriber of a Foxglove channel.
  void offer(std::size_t channel, Time stamp, std::string_view message);
  /// True once, after the page's upgrade: hello is to be sent.
  [[nodiscard]] bool has_joined() noexcept { return std::exchange(joined_, false); }
  /// Channels that it has just subscribed to, once: what they last said is to be sent.
  [[nodiscard]] std::vector<std::size_t> subscribed() noexcept { return std::exchange(subscribed_, {}); }
  /// The same as offer(), but behind what is unsent: for the few messages that a newcomer needs.
  void queue(std::string_view message);
  void queue(std::size_t channel, Time stamp, std::string_view message);

  [[nodiscard]] int socket() const noexcept { return socket_.get(); }
  [[nodiscard]] bool has_unsent() const noexcept { return !unsent_.empty(); }
  [[nodiscard]] bool is_page() const noexcept { return upgraded_ && !foxglove_; }
  /// A bit a channel that it subscribes to.
  [[nodiscard]] std::uint32_t wanted() const { return foxglove_ ? foxglove_->wanted() : 0; }

 private:
  [[nodiscard]] bool receive(Clock::time_point now);
  [[nodiscard]] bool flush();
  [[nodiscard]] bool is_idle(Clock::time_point now);
  void answer_http();
  void upgrade(const std::string& key, const std::string& subprotocol);
  void answer_frames();
  void answer(const ClientFrame& frame);
  void obey(const FoxgloveSession::Outcome& outcome);
  void refuse(std::string_view status, std::string_view why);

  wire::FileDescriptor socket_;
  const ViewRules& rules_;
  std::string received_, unsent_;
  std::optional<FoxgloveSession> foxglove_;
  std::vector<std::size_t> subscribed_;
  Clock::time_point heard_ = Clock::now(), pinged_ = heard_;
  bool upgraded_ = false, joined_ = false, ends_ = false;
};

}  // namespace jaywalk::view
