#pragma once
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <optional>
#include <utility>

namespace jaywalk::view {
/// A connection, with TLS over it once it is begun: one type for Beast's HTTP and WebSocket.
class DoorStream {
 public:
  using next_layer_type = boost::asio::ip::tcp::socket;
  using executor_type = next_layer_type::executor_type;

  explicit DoorStream(next_layer_type socket) : socket_(std::move(socket)) {}
  [[nodiscard]] executor_type get_executor() { return socket_.get_executor(); }
  [[nodiscard]] next_layer_type& next_layer() { return socket_; }
  [[nodiscard]] const next_layer_type& next_layer() const { return socket_; }
  [[nodiscard]] bool is_encrypted() const noexcept { return tls_.has_value(); }

  using Role = boost::asio::ssl::stream_base::handshake_type;
  /// `received`: what came of the handshake so far; the handler is told how much of it was used.
  template <class Buffers, class Handler>
  void begin_tls(Role role, boost::asio::ssl::context& context, const Buffers& received, Handler handler) {
    tls_.emplace(socket_, context).async_handshake(role, received, std::move(handler));
  }
  template <class Buffers, class Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    if (tls_) return tls_->async_read_some(buffers, std::forward<Handler>(handler));
    socket_.async_read_some(buffers, std::forward<Handler>(handler));
  }
  template <class Buffers, class Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    if (tls_) return tls_->async_write_some(buffers, std::forward<Handler>(handler));
    socket_.async_write_some(buffers, std::forward<Handler>(handler));
  }

 private:
  next_layer_type socket_;
  std::optional<boost::asio::ssl::stream<next_layer_type&>> tls_;
};

/// Beast calls this when a WebSocket has ended. The WebSocket's closing frame has shown that nothing was cut off, so
/// the connection is closed without TLS's own closing message.
template <class Handler>
void async_teardown(boost::beast::role_type role, DoorStream& stream, Handler&& handler) {
  boost::beast::websocket::async_teardown(role, stream.next_layer(), std::forward<Handler>(handler));
}

}  // namespace jaywalk::view
