#pragma once
// One client's connection, by Boost.Beast, which takes long to compile: no other header includes this one.
// Rules of the live page's server: requests it answers, places of clients, messages that wait. None needs a connection.
#include <array>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstdint>
#include <deque>
#include <list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "apps/view/foxglove_session.h"
#include "apps/view/secret.h"
#include "apps/view/view_server.h"

namespace jaywalk::view {

/// Which requests are answered.
struct ViewRules {
  std::string token{};   ///< to be given as ?token=; empty: none is wanted
  std::string origin{};  ///< another site that may open a WebSocket; empty: none
  bool loopback = true;  ///< served on 127.0.0.1 alone; else other machines must come by TLS
};

/// A request, and what is known of its connection.
struct ViewRequest {
  std::string method{}, target{}, host{}, origin{};
  std::string subprotocols{};  ///< Sec-WebSocket-Protocol
  bool is_upgrade = false;     ///< to a WebSocket
  bool is_local = false;       ///< from this machine
  bool is_encrypted = false;
};

enum class Service : std::uint8_t { kNone, kPage, kStop, kSocket };

struct ViewVerdict {
  Service service = Service::kNone;
  unsigned status = 200;      ///< of HTTP
  std::string said{};         ///< why it is refused
  std::string subprotocol{};  ///< a Foxglove client's; empty: the page's own WebSocket
};

/// GET / is the page; its WebSocket is /ws, Foxglove's any path: both want the token where there is one, and to be
/// asked for by our own page or that of the named site, or with the token by a desktop program (Origin "null" or
/// file:). POST /stop is a stop: from this machine it wants nothing, so that any page open in a browser here may stop
/// the robot, and none may move it.
[[nodiscard]] ViewVerdict judge(const ViewRequest& request, const ViewRules& rules);

/// How far a client has come.
enum class Stage : std::uint8_t {
  kAsks,        ///< its request is not whole yet
  kEncrypts,    ///< nor that, by TLS: it costs a hundred times the memory
  kIsAnswered,  ///< a page, a stop or a refusal is on its way to it
  kLooks,       ///< it has a WebSocket
  kGone
};

/// Places of a stage; this machine's clients and those of others have as many each, so that neither take the other's.
[[nodiscard]] constexpr std::size_t places(Stage stage) noexcept {
  constexpr std::size_t kPlaces[] = {128, 64, 16, 8, 0};
  return kPlaces[static_cast<std::size_t>(stage)];
}

/// A client in its place.
struct Placed {
  using Clock = std::chrono::steady_clock;
  std::uint32_t address = 0;
  Clock::time_point since{};
  Clock::duration stuck{};  ///< for how long it has taken nothing of what is sent to it
  bool is_served = false;   ///< its answer is whole in the kernel's hands
};

/// Which of `placed` gives way to one more of `address` where all places are taken. Before it looks: one that is
/// served, else the oldest of the address that has most places, so that many requests from one address turn away each
/// other. Looking: the one stuck longest, from a second on; else the oldest of an address that has at least two more
/// than the newcomer's; else none does.
[[nodiscard]] std::optional<std::size_t> gives_way(std::span<const Placed> placed, Stage stage, std::uint32_t address);

/// Messages that wait to be sent to one client: kMostBytes and one message at most, whatever it asks for. Clients
/// that are sent the same message share its body.
class Outbox {
 public:
  static constexpr std::size_t kMostBytes = 512U << 10U;

  struct Message {
    std::string head;
    std::shared_ptr<const std::string> body;
    bool is_text = true;
  };
  /// False: there was no room for it.
  bool add(Message message) {
    if (bytes_ >= kMostBytes) return false;
    bytes_ += size(message);
    waiting_.push_back(std::move(message));
    return true;
  }
  [[nodiscard]] const Message& front() const { return waiting_.front(); }
  void pop() {
    bytes_ -= size(front());
    waiting_.pop_front();
  }
  [[nodiscard]] bool is_empty() const noexcept { return waiting_.empty(); }
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }

 private:
  /// Small ones count for what it takes to keep them.
  static std::size_t size(const Message& message) {
    return sizeof message + message.head.size() + message.body->size();
  }
  std::deque<Message> waiting_;
  std::size_t bytes_ = 0;
};

class ViewClient;

class BeastServer final : public ViewServer {
 public:
  BeastServer(const ViewAddress& where, ViewDoor asked);
  ~BeastServer() override;

  /// Gives `client` a place of that stage; false: there is none.
  [[nodiscard]] bool enter(ViewClient& client, Stage stage);
  /// Offers what the page shows to a client that has a WebSocket now.
  void welcome(ViewClient& client);
  /// Offers what a channel said last to a client that subscribes to it.
  void repeat(ViewClient& client, std::size_t channel);

  std::shared_ptr<boost::asio::io_context> io = std::make_shared<boost::asio::io_context>(1);
  std::shared_ptr<boost::asio::ssl::context> tls;  ///< none: not served
  ViewRules rules;
  ViewDoor door;

 private:
  using Clock = std::chrono::steady_clock;
  void listen(const boost::asio::ip::tcp::endpoint& at);
  void await_newcomers();
  void accept_newcomers();
  void tick();
  void pass_on();
  void count_clients();

  boost::asio::ip::tcp::acceptor listener_{*io};
  boost::asio::steady_timer timer_{*io};
  std::list<std::shared_ptr<ViewClient>> clients_;
  std::array<ViewMessage, 2> kept_;  ///< hello and the newest field
  std::vector<ViewMessage> said_;    ///< by each channel, last
  bool lacks_descriptor_ = false;
  std::atomic<bool> ends_{false};
  Clock::time_point ended_{};
  std::thread thread_;
};

/// First TLS or not, as the client begins; then one request of HTTP; then, maybe, a WebSocket of the page's own or of
/// Foxglove's. Nothing waits. What it has not read is bounded (Outbox): a client with much unread is asked for nothing
/// more, and loses messages; what it says is taken at kMessages_hz. Thread: the server's.
class ViewClient : public std::enable_shared_from_this<ViewClient> {
 public:
  using Clock = std::chrono::steady_clock;

  ViewClient(boost::asio::ip::tcp::socket socket, BeastServer& server);
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
  void say(const std::string& text, bool is_text = true);
  void send(Outbox::Message message);
  void write_on();
  /// A handler that does nothing when something went wrong but close.
  template <class Next>
  auto then(Next next);
  template <class Take>
  Reply reply_to(Take take);

  boost::beast::websocket::stream<DoorStream> socket_;
  BeastServer& server_;
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
