#include "apps/dds/foxglove_client.h"

#include <charconv>
#include <cstring>
#include <nlohmann/json.hpp>

#include "apps/view/secret.h"
#include "hal/types/errors.h"

namespace jaywalk::dds {
namespace {
namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;
using Json = nlohmann::json;

constexpr char kMessageData = 1;  // of server and client alike
constexpr std::size_t kSubscriptionHead = 13, kMostPayload = 64U << 20U;
constexpr std::uint32_t kGoalChannel = 1, kPlaceChannel = 2;
constexpr std::chrono::seconds kPatience{5};
constexpr const char* kRemedy = "give the address that a run with --view prints";

struct Address {
  asio::ip::tcp::endpoint at;
  std::string host;    ///< "127.0.0.1:8080"
  std::string target;  ///< "/ws?token=..."
  bool is_encrypted = false;
};

Address address_of(const std::string& url) {
  Address address;
  address.is_encrypted = url.starts_with("https://");
  const std::string rest = url.substr(url.starts_with("http") ? url.find("://") + 3 : 0);
  const std::size_t colon = rest.find(':'), slash = std::min(rest.find('/'), rest.size());
  std::uint16_t port = 0;
  boost::system::error_code error;
  const auto ip = asio::ip::make_address_v4(rest.substr(0, colon), error);
  const bool sound = colon < slash && !error &&
                     std::from_chars(rest.data() + colon + 1, rest.data() + slash, port).ptr == rest.data() + slash;
  if (!sound || port == 0) throw StartupError(url + ": no address as http://127.0.0.1:8080/", kRemedy);
  const std::size_t query = rest.find('?');
  address.at = {ip, port};
  address.host = rest.substr(0, slash);
  address.target = "/ws" + (query == std::string::npos ? "" : rest.substr(query));
  return address;
}

}  // namespace

FoxgloveClient::FoxgloveClient(const std::string& url, const std::string& fingerprint)
    : url_(url), socket_(asio::ip::tcp::socket(io_)) {
  const Address address = address_of(url);
  finish([&](auto done) { socket_.next_layer().next_layer().async_connect(address.at, done); });
  if (address.is_encrypted) begin_tls(fingerprint);
  socket_.set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
    request.set(boost::beast::http::field::sec_websocket_protocol, "foxglove.websocket.v1");
  }));
  socket_.read_message_max(kMostPayload);
  socket_.auto_fragment(false);
  finish([&](auto done) { socket_.async_handshake(address.host, address.target, done); });
  const auto channel = [](std::uint32_t id, const char* topic, const char* type) {
    return Json{{"id", id}, {"topic", topic}, {"encoding", "cdr"}, {"schemaName", type}};
  };
  const Json channels{channel(kGoalChannel, "/goal_pose", "geometry_msgs/msg/PoseStamped"),
                      channel(kPlaceChannel, "/initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped")};
  send(true, Json({{"op", "advertise"}, {"channels", channels}}).dump());
}

template <class Begin>
void FoxgloveClient::finish(Begin begin) {
  std::optional<Error> ended;
  begin([&ended](Error error, auto...) { ended = error; });
  const auto end = std::chrono::steady_clock::now() + kPatience;
  for (io_.restart(); !ended && std::chrono::steady_clock::now() < end;) io_.run_one_until(end);
  if (!ended) lost("no answer");
  if (*ended) lost(ended->message());
}

void FoxgloveClient::begin_tls(const std::string& fingerprint) {
  tls_.emplace(asio::ssl::context::tls_client);
  tls_->set_verify_mode(asio::ssl::verify_peer);
  tls_->set_verify_callback([fingerprint](bool, asio::ssl::verify_context& context) {
    return view::fingerprint_of(::X509_STORE_CTX_get_current_cert(context.native_handle())) == fingerprint;
  });
  finish([&](auto done) {
    socket_.next_layer().begin_tls(view::DoorStream::Role::client, *tls_, asio::const_buffer(), done);
  });
}

std::optional<FoxgloveMessage> FoxgloveClient::next(std::chrono::milliseconds wait) {
  const auto end = std::chrono::steady_clock::now() + wait;
  for (;;) {
    if (!reads_) socket_.async_read(received_, [this](Error error, std::size_t) { came_ = error; });
    reads_ = true;
    for (io_.restart(); !came_ && std::chrono::steady_clock::now() < end;) io_.run_one_until(end);
    if (!came_) return std::nullopt;
    if (*came_)
      lost(*came_ == websocket::error::closed || *came_ == asio::error::eof ? "the run has ended" : came_->message());
    const std::string payload(static_cast<const char*>(received_.cdata().data()), received_.size());
    received_.clear();
    came_.reset();
    reads_ = false;
    if (socket_.got_text()) take_text(payload);
    if (socket_.got_text() || payload.size() < kSubscriptionHead || payload[0] != kMessageData) continue;
    std::uint32_t number = 0;
    std::memcpy(&number, payload.data() + 1, sizeof number);  // little endian, as all our machines are
    const auto topic = subscribed_.find(number);
    if (topic != subscribed_.end()) return FoxgloveMessage{topic->second, payload.substr(kSubscriptionHead)};
  }
}

void FoxgloveClient::publish(const PoseOrder& order) {
  const std::uint32_t channel = order.is_place ? kPlaceChannel : kGoalChannel;
  std::string payload(1, kMessageData);
  payload.append(reinterpret_cast<const char*>(&channel), sizeof channel).append(order.message);
  send(false, payload);
}

void FoxgloveClient::take_text(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return;
  if (json.value("op", "") == "status")
    std::printf("jaywalk_dds: %s\n", json.value("message", "").c_str()), std::fflush(stdout);
  if (json.value("op", "") != "advertise") return;
  Json wishes = Json::array();
  for (const Json& channel : json.value("channels", Json::array())) {
    const std::string topic = channel.value("topic", "");
    if (!DdsTopics::passes(topic) || channel.value("encoding", "") != "cdr") continue;
    const auto id = static_cast<std::uint32_t>(subscribed_.size() + 1);
    subscribed_[id] = topic;
    wishes.push_back({{"id", id}, {"channelId", channel.value("id", 0U)}});
  }
  if (!wishes.empty()) send(true, Json({{"op", "subscribe"}, {"subscriptions", wishes}}).dump());
}

void FoxgloveClient::send(bool is_text, std::string_view payload) {
  socket_.binary(!is_text);
  finish([&](auto done) { socket_.async_write(asio::buffer(payload.data(), payload.size()), done); });
}

void FoxgloveClient::lost(const std::string& cause) const { throw StartupError(url_ + ": " + cause, kRemedy); }

}  // namespace jaywalk::dds
