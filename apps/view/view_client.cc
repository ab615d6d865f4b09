#include "apps/view/view_client.h"

#include <sys/socket.h>

#include <cerrno>

#include "apps/view/http.h"
#include "apps/view/live_page.h"

namespace jaywalk::view {
namespace {

constexpr std::size_t kMostReceived = 16384;  ///< bytes of a request's head, or of orders not yet read

/// A name that another site's page cannot have: else a foreign name that leads to this machine would do as well.
bool is_loopback_name(const std::string& host) {
  const std::string name = host.substr(0, host.rfind(':'));
  return name == "127.0.0.1" || name == "localhost";
}

/// Browsers say whose page opens a WebSocket: our own may and one that was named, since orders move the robot.
bool may_order(const HttpRequest& request, const std::string& named) {
  const std::string origin = request.header("origin");
  return origin.empty() || origin == named || origin == "http://" + request.header("host");
}

}  // namespace

bool ViewClient::serve(Clock::time_point now) {
  if (!receive(now) || is_idle(now)) return false;
  if (!ends_) upgraded_ ? answer_frames() : answer_http();
  return flush() && !(ends_ && unsent_.empty());
}

bool ViewClient::receive(Clock::time_point now) {
  char room[4096];
  const ssize_t count = ::recv(socket_.get(), room, sizeof room, MSG_DONTWAIT);
  if (count < 0) return errno == EAGAIN || errno == EINTR;
  received_.append(room, static_cast<std::size_t>(count));
  if (upgraded_) heard_ = now;  // a request has kUnasked in all
  return count > 0 && received_.size() <= kMostReceived;
}

bool ViewClient::is_idle(Clock::time_point now) {
  if (!upgraded_) return now - heard_ > kUnasked;
  if (now - pinged_ > kPing && unsent_.empty()) {
    unsent_ += to_frame(Opcode::kPing, "");
    pinged_ = now;
  }
  return now - heard_ > kIdle;
}

bool ViewClient::flush() {
  if (unsent_.empty()) return true;
  const ssize_t sent = ::send(socket_.get(), unsent_.data(), unsent_.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  if (sent < 0) return errno == EAGAIN || errno == EINTR;
  unsent_.erase(0, static_cast<std::size_t>(sent));
  return true;
}

void ViewClient::offer(std::string_view message) {
  if (!ends_ && unsent_.empty()) queue(message);
}

void ViewClient::queue(std::string_view message) {
  if (is_page()) unsent_ += to_frame(Opcode::kText, message);
}

void ViewClient::offer(std::size_t channel, Time stamp, std::string_view message) {
  constexpr std::size_t kMostWaiting = 1U << 20U;  ///< bytes: a tick's topics come one by one
  if (!ends_ && unsent_.size() < kMostWaiting) queue(channel, stamp, message);
}

void ViewClient::queue(std::size_t channel, Time stamp, std::string_view message) {
  const auto wanted = foxglove_ ? foxglove_->subscription(channel) : std::nullopt;
  if (wanted) unsent_ += to_frame(Opcode::kBinary, foxglove_message(*wanted, stamp, message));
}

void ViewClient::refuse(std::string_view status, std::string_view why) {
  unsent_ += http_answer(status, "text/plain; charset=utf-8", why);
  ends_ = true;
}

void ViewClient::answer_http() {
  const auto end = received_.find("\r\n\r\n");
  if (end == std::string::npos) return;
  const auto request = parse_request(std::string_view(received_).substr(0, end + 4));
  received_.erase(0, end + 4);
  if (!request || request->method != "GET") return refuse("400 Bad Request", "GET alone is served\n");
  if (rules_.loopback && !is_loopback_name(request->header("host")))
    return refuse("403 Forbidden", "ask for 127.0.0.1 or localhost\n");
  if (!rules_.token.empty() && query_value(request->query, "token") != rules_.token)
    return refuse("403 Forbidden", "the address that was printed ends in a token: give it whole\n");
  const std::string key = request->header("sec-websocket-key");
  const std::string subprotocol = foxglove_subprotocol(request->header("sec-websocket-protocol"));
  if (request->path == "/" && key.empty()) {
    unsent_ += http_answer("200 OK", "text/html; charset=utf-8", live_page());
    ends_ = true;
  } else if (request->path != "/ws" && subprotocol.empty()) {
    refuse("404 Not Found", "there are / and /ws\n");
  } else if (key.empty() || !may_order(*request, rules_.origin)) {
    refuse("403 Forbidden", "a WebSocket from this server's own page alone, or one named with --view-origin\n");
  } else {
    upgrade(key, subprotocol);
  }
}

void ViewClient::upgrade(const std::string& key, const std::string& subprotocol) {
  unsent_ += "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n";
  if (!subprotocol.empty()) unsent_ += "Sec-WebSocket-Protocol: " + subprotocol + "\r\n";
  unsent_ += "Sec-WebSocket-Accept: " + accept_key(key) + "\r\n\r\n";
  upgraded_ = true;
  joined_ = subprotocol.empty();
  if (joined_) return;
  foxglove_.emplace(rules_.channels.size());
  for (const std::string& text : foxglove_greeting(rules_.channels)) unsent_ += to_frame(Opcode::kText, text);
}

void ViewClient::answer_frames() {
  ClientFrame frame;
  FrameState state = take_frame(received_, frame);
  for (; state == FrameState::kWhole; state = take_frame(received_, frame)) answer(frame);
  ends_ = ends_ || state == FrameState::kRefused;
}

void ViewClient::answer(const ClientFrame& frame) {
  if (frame.opcode == Opcode::kPing && unsent_.empty()) unsent_ += to_frame(Opcode::kPong, frame.payload);
  if (frame.opcode == Opcode::kClose) unsent_ += to_frame(Opcode::kClose, ""), ends_ = true;
  if (frame.opcode == Opcode::kBinary && foxglove_) obey(foxglove_->take_binary(frame.payload));
  if (frame.opcode != Opcode::kText) return;
  if (foxglove_) return obey(foxglove_->take_text(frame.payload));
  if (const std::string answer = rules_.on_order(frame.payload); !answer.empty()) queue(answer);
}

void ViewClient::obey(const FoxgloveSession::Outcome& outcome) {
  if (!outcome.order.empty()) static_cast<void>(rules_.on_order(outcome.order));
  if (!outcome.status.empty()) unsent_ += to_frame(Opcode::kText, outcome.status);
  subscribed_.insert(subscribed_.end(), outcome.subscribed.begin(), outcome.subscribed.end());
}

}  // namespace jaywalk::view
