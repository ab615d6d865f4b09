#pragma once
// One client's connection, by Boost.Beast. Included by the server alone: Beast takes long to compile.
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <memory>
#include <optional>
#include <string>

#include "apps/view/door_stream.h"
#include "apps/view/foxglove_session.h"
#include "apps/view/view_rules.h"
#include "apps/view/view_server.h"

namespace jaywalk::view {
class ViewClient;

/// What a client is served by.
struct ViewHouse {
  ViewHouse() = default;
  ViewHouse(const ViewHouse&) = delete;
  ViewHouse& operator=(const ViewHouse&) = delete;
  virtual ~ViewHouse() = default;
  /// Gives `client` a place of that stage; false: there is none.
  [[nodiscard]] virtual bool enter(ViewClient& client, Stage stage) = 0;
  /// It has a WebSocket now: offers what the page shows.
  virtual void welcome(ViewClient& client) = 0;
  /// It subscribes to a channel: offers what that said last.
  virtual void repeat(ViewClient& client, std::size_t channel) = 0;

  std::shared_ptr<boost::asio::io_context> io = std::make_shared<boost::asio::io_context>(1);
  std::shared_ptr<boost::asio::ssl::context> tls;  ///< none: not served
  ViewRules rules;
  ViewDoor door;
};

/// First TLS or not, as the client begins; then one request of HTTP; then, maybe, a WebSocket of the page's own or of
/// Foxglove's. Nothing waits. What it has not read is bounded (Outbox): a client with much unread is asked for nothing
/// more, and loses messages; what it says is taken at kMessages_hz. Thread: the server's.
class ViewClient : public std::enable_shared_from_this<ViewClient> {
 public:
  using Clock = std::chrono::steady_clock;

  ViewClient(boost::asio::ip::tcp::socket socket, ViewHouse& house);
  void start();
  /// From time to time: ends what is late, and goes on reading.
  void tick(Clock::time_point now);
  /// Sends the message if it is for this client and there is room.
  void offer(const ViewMessage& message);
  void close() noexcept;

  [[nodiscard]] Placed placed(Clock::time_point now) const noexcept;
  [[nodiscard]] Stage stage() const noexcept { return stage_; }
  void set_stage(Stage stage) noexcept { stage_ = stage; }
  [[nodiscard]] bool is_local() const noexcept { return local_; }
  [[nodiscard]] bool has_unsent() const noexcept { return !outbox_.is_empty(); }
  [[nodiscard]] bool is_page() const noexcept { return stage_ == Stage::kLooks && !foxglove_; }
  /// A bit a channel that it subscribes to.
  [[nodiscard]] std::uint32_t wanted() const { return stage_ == Stage::kLooks && foxglove_ ? foxglove_->wanted() : 0; }

 private:
  using Error = boost::beast::error_code;
  using Status = boost::beast::http::status;
  void read_request();
  void answer_request();
  void respond(Status status, const char* type, std::string body);
  void upgrade(const std::string& subprotocol);
  void read_on();
  void take_message();
  void obey(const FoxgloveSession::Outcome& outcome);
  void send(Outbox::Message message);
  void write_on();
  /// A handler that does nothing when something went wrong but close.
  template <class Next>
  auto then(Next next);
  template <class Take>
  Reply reply_to(Take take);

  boost::beast::websocket::stream<DoorStream> socket_;
  ViewHouse& house_;
  std::uint32_t address_ = 0;
  bool local_ = false;
  Stage stage_ = Stage::kGone;
  Clock::time_point since_ = Clock::now(), ticked_ = since_, writing_since_{};
  boost::beast::flat_buffer received_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::string_body>> request_;
  std::optional<boost::beast::http::response<boost::beast::http::string_body>> response_;
  std::optional<FoxgloveSession> foxglove_;
  Outbox outbox_;
  double allowance_;  ///< messages that it may send now
  bool reads_ = false, writes_ = false, served_ = false;
};

}  // namespace jaywalk::view
