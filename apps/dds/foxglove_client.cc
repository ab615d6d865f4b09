#include "apps/dds/foxglove_client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <charconv>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "hal/types/errors.h"

namespace jaywalk::dds {
namespace {

using Json = nlohmann::json;

constexpr std::uint8_t kText = 1, kBinary = 2, kClose = 8, kPing = 9, kPong = 10;
constexpr char kMessageData = 1;  // of server and client alike
constexpr std::size_t kSubscriptionHead = 13, kMostPayload = 64U << 20U;
constexpr std::uint32_t kGoalChannel = 1;
constexpr const char* kRemedy = "give the address that a run with --view prints";

struct Address {
  sockaddr_in at{};
  std::string host;   ///< "127.0.0.1:8080"
  std::string query;  ///< "?token=..." or empty
};

Address address_of(const std::string& url) {
  constexpr std::string_view kScheme = "http://";
  const std::string rest = url.rfind(kScheme, 0) == 0 ? url.substr(kScheme.size()) : url;
  const std::size_t colon = rest.find(':'), slash = std::min(rest.find('/'), rest.size());
  std::uint16_t port = 0;
  Address address;
  address.at.sin_family = AF_INET;
  const bool sound = colon < slash && inet_pton(AF_INET, rest.substr(0, colon).c_str(), &address.at.sin_addr) == 1 &&
                     std::from_chars(rest.data() + colon + 1, rest.data() + slash, port).ptr == rest.data() + slash;
  if (!sound || port == 0) throw StartupError(url + ": no address as http://127.0.0.1:8080/", kRemedy);
  address.at.sin_port = htons(port);
  address.host = rest.substr(0, slash);
  const std::size_t query = rest.find('?');
  if (query != std::string::npos) address.query = rest.substr(query);
  return address;
}

std::string big_endian(std::uint64_t value, int bytes) {
  std::string text;
  for (int k = bytes - 1; k >= 0; --k) text += static_cast<char>(value >> (8 * k));
  return text;
}

std::uint32_t u32_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);  // little endian, as all our machines are
  return value;
}

}  // namespace

FoxgloveClient::FoxgloveClient(const std::string& url, std::set<std::string> topics)
    : url_(url), topics_(std::move(topics)), socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  const Address address = address_of(url);
  if (connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address.at), sizeof address.at) != 0)
    throw StartupError(url + ": " + std::strerror(errno), kRemedy);
  send_all("GET /ws" + address.query + " HTTP/1.1\r\nHost: " + address.host +
           "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
           "Sec-WebSocket-Key: amF5d2Fsa19kZHMgYmVnaW4=\r\nSec-WebSocket-Protocol: foxglove.websocket.v1\r\n\r\n");
  while (received_.find("\r\n\r\n") == std::string::npos) receive(std::chrono::seconds(5));
  if (received_.rfind("HTTP/1.1 101", 0) != 0) lost(received_.substr(0, received_.find('\r')));
  received_.erase(0, received_.find("\r\n\r\n") + 4);
  send(kText, Json({{"op", "advertise"},
                    {"channels",
                     {{{"id", kGoalChannel},
                       {"topic", "/goal_pose"},
                       {"encoding", "cdr"},
                       {"schemaName", "geometry_msgs/msg/PoseStamped"}}}}})
                  .dump());
}

std::optional<FoxgloveMessage> FoxgloveClient::next(std::chrono::milliseconds wait) {
  for (bool waited = false;;) {
    const auto frame = take_frame();
    if (!frame && std::exchange(waited, true)) return std::nullopt;
    if (!frame) {
      pollfd ready{socket_.get(), POLLIN, 0};
      if (poll(&ready, 1, static_cast<int>(wait.count())) > 0) receive(wait);
      continue;
    }
    const auto& [opcode, payload] = *frame;
    if (opcode == kClose) lost("the run has ended");
    if (opcode == kPing) send(kPong, payload);
    if (opcode == kText) take_text(payload);
    if (opcode != kBinary || payload.size() < kSubscriptionHead || payload[0] != kMessageData) continue;
    const auto topic = subscribed_.find(u32_at(payload, 1));
    if (topic != subscribed_.end()) return FoxgloveMessage{topic->second, payload.substr(kSubscriptionHead)};
  }
}

void FoxgloveClient::publish_goal(std::string_view message) {
  std::string payload(1, kMessageData);
  payload.append(reinterpret_cast<const char*>(&kGoalChannel), sizeof kGoalChannel).append(message);
  send(kBinary, payload);
}

void FoxgloveClient::take_text(const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || json.value("op", "") != "advertise") return;
  Json wishes = Json::array();
  for (const Json& channel : json.value("channels", Json::array())) {
    const std::string topic = channel.value("topic", "");
    if (topics_.count(topic) == 0 || channel.value("encoding", "") != "cdr") continue;
    const auto id = static_cast<std::uint32_t>(subscribed_.size() + 1);
    subscribed_[id] = topic;
    wishes.push_back({{"id", id}, {"channelId", channel.value("id", 0U)}});
  }
  if (!wishes.empty()) send(kText, Json({{"op", "subscribe"}, {"subscriptions", wishes}}).dump());
}

void FoxgloveClient::send(std::uint8_t opcode, std::string_view payload) {
  constexpr std::uint8_t kWhole = 0x80, kMasked = 0x80;
  std::string frame(1, static_cast<char>(kWhole | opcode));
  if (payload.size() < 126) {
    frame += static_cast<char>(kMasked | payload.size());
  } else {
    frame += static_cast<char>(kMasked | 126U);
    frame += big_endian(payload.size(), 2);
  }
  frame.append(4, '\0');  // a mask of zeros: masks are for proxies between, and there is none
  send_all(frame.append(payload));
}

void FoxgloveClient::send_all(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) lost(std::strerror(errno));
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

void FoxgloveClient::receive(std::chrono::milliseconds wait) {
  pollfd ready{socket_.get(), POLLIN, 0};
  if (poll(&ready, 1, static_cast<int>(wait.count())) == 0) lost("no answer");
  std::string block(1U << 16U, '\0');
  const ssize_t got = recv(socket_.get(), block.data(), block.size(), 0);
  if (got == 0) lost("the run has ended");
  if (got < 0) lost(std::strerror(errno));
  received_.append(block.data(), static_cast<std::size_t>(got));
}

std::optional<std::pair<std::uint8_t, std::string>> FoxgloveClient::take_frame() {
  const auto byte = [this](std::size_t k) { return static_cast<std::uint8_t>(received_[k]); };
  if (received_.size() < 2) return std::nullopt;
  const std::size_t short_length = byte(1) & 0x7FU;
  const std::size_t more = short_length == 126 ? 2 : short_length == 127 ? 8 : 0;
  if (received_.size() < 2 + more) return std::nullopt;
  std::uint64_t length = more == 0 ? short_length : 0;
  for (std::size_t k = 0; k < more; ++k) length = length << 8U | byte(2 + k);
  if (length > kMostPayload) lost("a frame of " + std::to_string(length) + " bytes");
  if (received_.size() - 2 - more < length) return std::nullopt;
  std::pair<std::uint8_t, std::string> frame(byte(0) & 0x0FU, received_.substr(2 + more, length));
  received_.erase(0, 2 + more + length);
  return frame;
}

void FoxgloveClient::lost(const std::string& cause) const { throw StartupError(url_ + ": " + cause, kRemedy); }

}  // namespace jaywalk::dds
