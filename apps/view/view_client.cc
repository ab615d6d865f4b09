#include "apps/view/view_client.h"

#include <openssl/crypto.h>

#include <algorithm>
#include <boost/beast/core/detect_ssl.hpp>
#include <map>

namespace jaywalk::view {
namespace {
namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;

constexpr std::chrono::seconds kStuck{1};
constexpr std::size_t kMostRequest = 8192;     ///< bytes of its head; a body is not wanted
constexpr std::size_t kMostPayload = 8192;     ///< orders have about 50, an advertisement with its schema some hundred
constexpr std::size_t kMostUnread = 64 << 10;  ///< bytes: a client with more is asked for nothing
constexpr std::chrono::seconds kAnswered{5};   ///< from its first byte to the answer's last
constexpr std::chrono::seconds kQuiet{30};     ///< a WebSocket; it is asked by a ping after half of it
constexpr double kMessages_hz = 50.0, kMostAtOnce = 100.0;

/// A name that another site's page cannot have: else a foreign name that leads to this machine would do as well.
bool is_loopback_name(const std::string& host) {
  const std::string name = host.substr(0, host.rfind(':'));
  return name == "127.0.0.1" || name == "localhost";
}

/// Desktop programs built on a browser (Foxglove) send "file://" or "null"; so does a page in a sandboxed frame.
bool has_no_site(const std::string& origin) { return origin == "null" || origin.starts_with("file://"); }

/// Browsers send the site of the page that opens a WebSocket (Origin). Orders move the robot, so only our own page and
/// the configured site may open one. A desktop program has no site: it must have given the token.
bool may_order(const ViewRequest& request, const ViewRules& rules) {
  if (has_no_site(request.origin)) return !rules.token.empty();
  const std::string scheme = request.is_encrypted ? "https://" : "http://";
  return request.origin.empty() || request.origin == rules.origin || request.origin == scheme + request.host;
}

/// The value of `name` in a query such as "a=1&token=2"; empty where it is not there.
std::string_view query_value(std::string_view query, std::string_view name) {
  while (!query.empty()) {
    const std::string_view part = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(query.size(), part.size() + 1));
    if (part.starts_with(name) && part.substr(name.size()).starts_with('=')) return part.substr(name.size() + 1);
  }
  return "";
}

/// Takes the same time whatever differs.
bool is_same_secret(std::string_view a, std::string_view b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

ViewVerdict refused(unsigned status, std::string said) { return {.status = status, .said = std::move(said) + "\n"}; }

std::string text_of(beast::string_view text) { return {text.data(), text.size()}; }

}  // namespace

ViewVerdict judge(const ViewRequest& request, const ViewRules& rules) {
  const std::string_view target = request.target, path = target.substr(0, target.find('?'));
  const std::string_view query = target.substr(std::min(target.size(), path.size() + 1));
  const bool permitted = rules.token.empty() || is_same_secret(query_value(query, "token"), rules.token);
  if (!rules.loopback && !request.is_encrypted && !request.is_local)
    return refused(403, "another machine must ask by https://");
  if (path == "/stop" && request.method != "POST") return refused(405, "a stop is a POST");
  if (path == "/stop" && (permitted || request.is_local)) return {.service = Service::kStop};
  if (path != "/stop" && request.method != "GET") return refused(405, "GET is served, and POST /stop");
  if (rules.loopback && !is_loopback_name(request.host)) return refused(403, "ask for 127.0.0.1 or localhost");
  if (!permitted) return refused(403, "the address that was printed ends in a token: give it whole");
  const std::string subprotocol = foxglove_subprotocol(request.subprotocols);
  if (path == "/" && !request.is_upgrade) return {.service = Service::kPage};
  if (path != "/ws" && subprotocol.empty()) return refused(404, "there are /, /ws and /stop");
  if (!request.is_upgrade || !may_order(request, rules))
    return refused(403, "a WebSocket from this server's own page alone, or one named with --view-origin");
  return {.service = Service::kSocket, .status = 101, .subprotocol = subprotocol};
}

std::optional<std::size_t> gives_way(std::span<const Placed> placed, Stage stage, std::uint32_t address) {
  std::map<std::uint32_t, std::size_t> held;
  for (const Placed& one : placed) ++held[one.address];
  const auto stuck = [stage](const Placed& one) {
    return stage == Stage::kLooks && one.stuck >= kStuck ? one.stuck : Placed::Clock::duration{};
  };
  const auto is_worse = [&](const Placed& a, const Placed& b) {  // a goes rather than b
    if (a.is_served != b.is_served) return a.is_served;
    if (stuck(a) != stuck(b)) return stuck(a) > stuck(b);
    return held[a.address] != held[b.address] ? held[a.address] > held[b.address] : a.since < b.since;
  };
  const auto worst = std::min_element(placed.begin(), placed.end(), is_worse);
  if (worst == placed.end()) return std::nullopt;
  const bool must = stage != Stage::kLooks || stuck(*worst) >= kStuck || held[worst->address] >= held[address] + 2;
  return must ? std::optional(static_cast<std::size_t>(worst - placed.begin())) : std::nullopt;
}

ViewClient::ViewClient(asio::ip::tcp::socket socket, BeastServer& server)
    : socket_(std::move(socket)), server_(server), received_(2 * kMostRequest), allowance_(kMostAtOnce) {
  Error error;
  auto& tcp = socket_.next_layer().next_layer();
  tcp.set_option(asio::ip::tcp::no_delay(true), error);
  const auto peer = tcp.remote_endpoint(error).address(), own = tcp.local_endpoint(error).address();
  if (error || !peer.is_v4()) return;
  address_ = peer.to_v4().to_uint();
  local_ = peer.is_loopback() || peer == own;
}

template <class Next>
auto ViewClient::then(Next next) {
  return
      [self = shared_from_this(), next](Error error, auto... count) { error ? self->close() : next(*self, count...); };
}

template <class Take>
Reply ViewClient::reply_to(Take take) {
  return [io = server_.io, self = weak_from_this(), take](std::string text) {
    asio::post(*io, [self, take, text = std::move(text)] {
      if (const auto client = self.lock(); client && client->stage() != Stage::kGone) take(*client, text);
    });
  };
}

void ViewClient::start() {
  if (!server_.tls) return read_request();
  beast::async_detect_ssl(socket_.next_layer(), received_, then([](ViewClient& client, bool is_tls) {
                            if (!is_tls) return client.read_request();
                            static_cast<void>(client.server_.enter(client, Stage::kEncrypts));
                            client.socket_.next_layer().begin_tls(
                                DoorStream::Role::server, *client.server_.tls, client.received_.data(),
                                client.then([](ViewClient& encrypted, std::size_t used) {
                                  encrypted.received_.consume(used);
                                  encrypted.read_request();
                                }));
                          }));
}

void ViewClient::read_request() {
  request_.emplace().header_limit(kMostRequest);
  request_->body_limit(kMostRequest);
  http::async_read(socket_.next_layer(), received_, *request_, [self = shared_from_this()](Error error, std::size_t) {
    if (error && error.category() == http::make_error_code(http::error::bad_target).category())
      return self->respond(Status::bad_request, "text/plain", error.message() + "\n");
    error ? self->close() : self->answer_request();
  });
}

void ViewClient::answer_request() {
  const auto& asked = request_->get();
  const ViewVerdict verdict = judge({.method = text_of(asked.method_string()),
                                     .target = text_of(asked.target()),
                                     .host = text_of(asked[http::field::host]),
                                     .origin = text_of(asked[http::field::origin]),
                                     .subprotocols = text_of(asked[http::field::sec_websocket_protocol]),
                                     .is_upgrade = websocket::is_upgrade(asked),
                                     .is_local = local_,
                                     .is_encrypted = socket_.next_layer().is_encrypted()},
                                    server_.rules);
  if (stage_ == Stage::kGone && verdict.service != Service::kStop) return;  // gave way before it was heard
  if (verdict.service == Service::kSocket) return upgrade(verdict.subprotocol);
  static_cast<void>(server_.enter(*this, Stage::kIsAnswered));
  if (verdict.service == Service::kPage)
    return respond(Status::ok, "text/html; charset=utf-8", std::string(live_page()));
  if (verdict.service == Service::kStop)
    return server_.door.on_order(R"({"stop":true})", reply_to([](ViewClient& client, const std::string& said) {
                                   client.respond(Status::ok, "application/json", said);
                                 }));
  respond(http::int_to_status(verdict.status), "text/plain; charset=utf-8", verdict.said);
}

void ViewClient::respond(Status status, const char* type, std::string body) {
  response_.emplace(status, 11);
  response_->set(http::field::content_type, type);
  response_->set(http::field::cache_control, "no-store");
  response_->set(http::field::x_frame_options, "DENY");
  response_->set("Referrer-Policy", "no-referrer");
  response_->body() = std::move(body);
  response_->keep_alive(false);
  response_->prepare_payload();
  http::async_write(socket_.next_layer(), *response_, then([](ViewClient& client, std::size_t) {
                      client.served_ = true;
                      Error error;  // closed at once, what it still sends would make the kernel take the answer back
                      auto& tcp = client.socket_.next_layer().next_layer();
                      tcp.shutdown(asio::ip::tcp::socket::shutdown_send, error);
                      tcp.async_wait(asio::ip::tcp::socket::wait_read,
                                     client.then([](ViewClient& heard) { heard.close(); }));
                    }));
}

void ViewClient::upgrade(const std::string& subprotocol) {
  if (!server_.enter(*this, Stage::kLooks)) {
    static_cast<void>(server_.enter(*this, Stage::kIsAnswered));
    return respond(Status::service_unavailable, "text/plain", "as many look as may: close a page\n");
  }
  if (!subprotocol.empty()) foxglove_.emplace(server_.door.channels.size(), server_.door.parameters);
  socket_.set_option(websocket::stream_base::timeout{kAnswered, kQuiet, true});
  socket_.set_option(websocket::stream_base::decorator([subprotocol](websocket::response_type& response) {
    if (!subprotocol.empty()) response.set(http::field::sec_websocket_protocol, subprotocol);
  }));
  socket_.read_message_max(kMostPayload);
  socket_.auto_fragment(false);
  socket_.async_accept(request_->get(), then([](ViewClient& client) {
                         client.request_.reset();
                         client.received_.clear();
                         if (!client.foxglove_) client.server_.welcome(client);
                         if (client.foxglove_)
                           for (const std::string& text : foxglove_greeting(client.server_.door.channels))
                             client.say(text);
                         client.read_on();
                       }));
}

void ViewClient::read_on() {
  if (reads_ || request_ || stage_ != Stage::kLooks || outbox_.bytes() > kMostUnread || allowance_ < 1.0) return;
  reads_ = true;
  socket_.async_read(received_, then([](ViewClient& client, std::size_t) {
                       client.reads_ = false;
                       client.allowance_ -= 1.0;
                       client.take_message();
                       client.received_.clear();
                       client.read_on();
                     }));
}

void ViewClient::take_message() {
  const auto bytes = received_.cdata();
  const std::string_view text(static_cast<const char*>(bytes.data()), bytes.size());
  if (foxglove_) return obey(socket_.got_text() ? foxglove_->take_text(text) : foxglove_->take_binary(text));
  server_.door.on_order(text, reply_to([](ViewClient& client, const std::string& said) {
                          if (!said.empty()) client.say(said);
                        }));
}

void ViewClient::obey(const FoxgloveSession::Outcome& outcome) {
  if (!outcome.order.empty())
    server_.door.on_order(outcome.order, reply_to([call = outcome.call](ViewClient& client, const std::string& said) {
                            if (call.empty()) return client.say(foxglove_answer(said));
                            client.say(foxglove_service_answer(call, said), false);
                          }));
  if (!outcome.status.empty()) say(outcome.status);
  for (const std::size_t channel : outcome.subscribed) server_.repeat(*this, channel);
}

void ViewClient::offer(const ViewMessage& message) {
  if (stage_ != Stage::kLooks || request_) return;
  const bool is_topic = message.kind == MessageKind::kTopic, is_page = message.kind < MessageKind::kTopic;
  if (is_page == foxglove_.has_value()) return;
  if (is_page && (message.kind != MessageKind::kFrame || outbox_.is_empty())) return send({"", message.text});
  if (message.kind == MessageKind::kTime) return send({foxglove_time(message.stamp), message.text, false});
  if (const auto wanted = is_topic ? foxglove_->subscription(message.channel) : std::nullopt)
    send({foxglove_head(*wanted, message.stamp), message.text, false});
}

void ViewClient::say(const std::string& text, bool is_text) {
  send({"", std::make_shared<const std::string>(text), is_text});
}

void ViewClient::send(Outbox::Message message) {
  if (outbox_.add(std::move(message)) && !writes_) write_on();
}

void ViewClient::write_on() {
  if (outbox_.is_empty() || stage_ == Stage::kGone) return;
  const Outbox::Message& next = outbox_.front();
  writes_ = true;
  writing_since_ = Clock::now();
  socket_.binary(!next.is_text);
  socket_.async_write(std::array{asio::buffer(next.head), asio::buffer(*next.body)},
                      then([](ViewClient& client, std::size_t) {
                        client.writes_ = false;
                        client.outbox_.pop();
                        client.write_on();
                        client.read_on();
                      }));
}

void ViewClient::tick(Clock::time_point now) {
  allowance_ = std::min(kMostAtOnce, allowance_ + kMessages_hz * std::chrono::duration<double>(now - ticked_).count());
  ticked_ = now;
  if (stage_ != Stage::kLooks && now - since_ > kAnswered) return close();
  if (writes_ && now - writing_since_ > kQuiet) return close();
  read_on();
}

Placed ViewClient::placed(Clock::time_point now) const noexcept {
  const Clock::duration stuck = writes_ ? now - writing_since_ : Clock::duration{};
  return {.address = address_, .since = since_, .stuck = stuck, .is_served = served_};
}

void ViewClient::close() noexcept {
  Error error;
  socket_.next_layer().next_layer().close(error);
  stage_ = Stage::kGone;
}

}  // namespace jaywalk::view
