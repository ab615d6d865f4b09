#pragma once
// Secrets of the live page: certificate, token, and the file that holds its address.
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace jaywalk::view {

/// TLS 1.2 or later with the certificate and key of a PEM file. `given` empty: jaywalk/view.pem in the user's state
/// folder ($XDG_STATE_HOME, ~/.local/state), self-signed, made at the first start, mode 0600. Throws StartupError where
/// that cannot be read or made.
[[nodiscard]] std::shared_ptr<boost::asio::ssl::context> tls_context(const std::filesystem::path& given);

/// SHA-256 of a certificate as browsers show it: "AB:CD:...".
[[nodiscard]] std::string fingerprint_of(const X509* certificate);

/// 128 random bits in hexadecimal. Throws StartupError where the system has none.
[[nodiscard]] std::string made_token();

/// A file beside the control socket, NAME.view, that holds the page's address with its token. Owner and group can read
/// it (mode 0640), as they can use the socket. The run's end removes it.
class AddressFile {
 public:
  /// Throws StartupError where it cannot be made, or its name is taken by what no run wrote.
  AddressFile(const std::filesystem::path& control_socket, const std::string& url);
  ~AddressFile();
  AddressFile(const AddressFile&) = delete;
  AddressFile& operator=(const AddressFile&) = delete;

 private:
  std::filesystem::path path_;
};

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
