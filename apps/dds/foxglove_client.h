#pragma once
// The client's end of foxglove.websocket.v1 (github.com/foxglove/ws-protocol, docs/spec.md), by Boost.Beast.
#include <boost/asio/io_context.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "apps/dds/dds_topics.h"
#include "apps/view/secret.h"

namespace jaywalk::dds {
struct FoxgloveMessage {
  std::string topic;
  std::string bytes;  ///< CDR, behind its encapsulation header
};

/// A live view of a run, from another process. Thread: one.
class FoxgloveClient {
 public:
  /// `url` as `jaywalk ... --view` prints it: http://ADDRESS:PORT/, with ?token= where one is wanted, or https:// with
  /// the certificate's `fingerprint`; IPv4. Subscribes to the run's topics that DdsTopics passes on. Throws
  /// StartupError where nothing answers there as it should.
  FoxgloveClient(const std::string& url, const std::string& fingerprint);

  /// The next message that comes within `wait`. Throws StartupError when the run has ended or the connection is lost.
  [[nodiscard]] std::optional<FoxgloveMessage> next(std::chrono::milliseconds wait);
  void publish(const PoseOrder& order);

 private:
  using Error = boost::system::error_code;
  /// Begins something with a handler, and waits for its end, five seconds at most.
  template <class Begin>
  void finish(Begin begin);
  void begin_tls(const std::string& fingerprint);
  void send(bool is_text, std::string_view payload);
  void take_text(std::string_view text);
  [[noreturn]] void lost(const std::string& cause) const;

  std::string url_;
  boost::asio::io_context io_;
  std::optional<boost::asio::ssl::context> tls_;
  boost::beast::websocket::stream<view::DoorStream> socket_;
  boost::beast::flat_buffer received_;
  std::optional<Error> came_;  ///< how the read that was begun last went
  bool reads_ = false;
  std::map<std::uint32_t, std::string> subscribed_;  ///< topics by their subscription's number
};

}  // namespace jaywalk::dds
