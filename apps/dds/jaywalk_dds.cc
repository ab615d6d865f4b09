// jaywalk_dds has two jobs, each in a process of its own: what a write to the network takes never meets a tick.
// With a run's address: passes its topics on to ROS 2 and other programs on DDS. With a robot file: passes its ROS 2
// devices on to the robot's program. With --goals either takes goals, and the place where the robot is.
#include <CLI/CLI.hpp>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/beast/websocket.hpp>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "apps/dds/dds_topics.h"
#include "apps/dds/robot_bridge.h"
#include "apps/formats/wire_reader.h"
#include "apps/view/secret.h"
#include "firmware/robot/control_socket.h"
#include "hal/types/errors.h"

namespace {
using namespace jaywalk;
namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;
using Json = nlohmann::json;

constexpr auto kWait = std::chrono::milliseconds(10);  // longest that a goal waits for its turn
constexpr auto kOrderPeriod = std::chrono::milliseconds(50);

std::atomic<bool> ends{false};  // threads and a signal look at it

struct Options {
  std::string from, fingerprint, space, control_socket;
  std::uint32_t domain = 0;
  bool takes_goals = false;
};

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

struct FoxgloveMessage {
  std::string topic;
  std::string bytes;  ///< CDR, behind its encapsulation header
};

/// A live view of a run, from another process: the client's end of foxglove.websocket.v1
/// (github.com/foxglove/ws-protocol, docs/spec.md), by Boost.Beast. Thread: one.
class FoxgloveClient {
 public:
  /// `url` as `jaywalk ... --view` prints it: http://ADDRESS:PORT/, with ?token= where one is wanted, or https:// with
  /// the certificate's `fingerprint`; IPv4. Subscribes to the run's topics that DdsTopics passes on. Throws
  /// StartupError where nothing answers there as it should.
  FoxgloveClient(const std::string& url, const std::string& fingerprint)
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

  /// The next message that comes within `wait`. Throws StartupError when the run has ended or the connection is lost.
  [[nodiscard]] std::optional<FoxgloveMessage> next(std::chrono::milliseconds wait) {
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
      const auto topic = subscribed_.find(exchange::WireReader(std::string_view(payload).substr(1)).u32());
      if (topic != subscribed_.end()) return FoxgloveMessage{topic->second, payload.substr(kSubscriptionHead)};
    }
  }

  void publish(const dds::PoseOrder& order) {
    send(false, kMessageData + exchange::raw(order.is_place ? kPlaceChannel : kGoalChannel) + order.message);
  }

 private:
  using Error = boost::system::error_code;

  /// Begins something with a handler, and waits for its end, five seconds at most.
  template <class Begin>
  void finish(Begin begin) {
    std::optional<Error> ended;
    begin([&ended](Error error, auto...) { ended = error; });
    const auto end = std::chrono::steady_clock::now() + kPatience;
    for (io_.restart(); !ended && std::chrono::steady_clock::now() < end;) io_.run_one_until(end);
    if (!ended) lost("no answer");
    if (*ended) lost(ended->message());
  }

  void begin_tls(const std::string& fingerprint) {
    tls_.emplace(asio::ssl::context::tls_client);
    tls_->set_verify_mode(asio::ssl::verify_peer);
    tls_->set_verify_callback([fingerprint](bool, asio::ssl::verify_context& context) {
      return view::fingerprint_of(::X509_STORE_CTX_get_current_cert(context.native_handle())) == fingerprint;
    });
    finish([&](auto done) {
      socket_.next_layer().begin_tls(view::DoorStream::Role::client, *tls_, asio::const_buffer(), done);
    });
  }

  void take_text(std::string_view text) {
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_object()) return;
    if (json.value("op", "") == "status")
      std::printf("jaywalk_dds: %s\n", json.value("message", "").c_str()), std::fflush(stdout);
    if (json.value("op", "") != "advertise") return;
    Json wishes = Json::array();
    for (const Json& channel : json.value("channels", Json::array())) {
      const std::string topic = channel.value("topic", "");
      if (!dds::DdsTopics::passes(topic) || channel.value("encoding", "") != "cdr") continue;
      const auto id = static_cast<std::uint32_t>(subscribed_.size() + 1);
      subscribed_[id] = topic;
      wishes.push_back({{"id", id}, {"channelId", channel.value("id", 0U)}});
    }
    if (!wishes.empty()) send(true, Json({{"op", "subscribe"}, {"subscriptions", wishes}}).dump());
  }

  void send(bool is_text, std::string_view payload) {
    socket_.binary(!is_text);
    finish([&](auto done) { socket_.async_write(asio::buffer(payload.data(), payload.size()), done); });
  }

  [[noreturn]] void lost(const std::string& cause) const { throw StartupError(url_ + ": " + cause, kRemedy); }

  std::string url_;
  asio::io_context io_;
  std::optional<asio::ssl::context> tls_;
  websocket::stream<view::DoorStream> socket_;
  boost::beast::flat_buffer received_;
  std::optional<Error> came_;  ///< how the read that was begun last went
  bool reads_ = false;
  std::map<std::uint32_t, std::string> subscribed_;  ///< topics by their subscription's number
};

void greet(const Options& options) {
  std::printf("jaywalk_dds: %s on DDS domain %u; %s\n", options.from.c_str(), options.domain,
              options.takes_goals ? "any program there can set goals and say where the robot is" : "takes no goals");
  std::fflush(stdout);
}

void pass_run_on(const Options& options) {
  dds::DdsTopics topics(options.domain, options.takes_goals, options.space);
  FoxgloveClient live(options.from, options.fingerprint);
  std::map<std::string, bool> refused;
  greet(options);
  while (!ends) {
    if (const auto message = live.next(kWait); message && !topics.publish(message->topic, message->bytes)) {
      if (!std::exchange(refused[message->topic], true))
        std::fprintf(stderr, "jaywalk_dds: rt%s: a message was not sent: its bytes do not fit its type\n",
                     message->topic.c_str());
    }
    if (const auto order = topics.take_order()) live.publish(*order);
  }
}

/// Returns the run's answer.
std::string say(const std::filesystem::path& socket, const dds::PoseOrder& order) {
  const std::string words = words_of(order);
  if (words.empty()) return "refused: no pose in the frame map\n";
  try {
    return ask(socket, words);
  } catch (const StartupError& error) {
    return std::string(error.what()) + "\n";
  }
}

void pass_orders(dds::PoseReader poses, const std::filesystem::path& socket) {
  for (; !ends; std::this_thread::sleep_for(kOrderPeriod)) {
    const auto order = poses.take();
    if (!order) continue;
    std::printf("jaywalk_dds: %s: %s", order->is_place ? "place" : "goal", say(socket, *order).c_str());
    std::fflush(stdout);
  }
}

void pass_robot_on(const Options& options) {
  const RobotFile robot = load_robot_file(options.from);
  std::filesystem::path socket = options.control_socket;
  if (socket.empty()) socket = robot.control_socket.empty() ? default_control_socket() : robot.control_socket;
  dds::RobotBridge bridge(robot, options.domain);
  greet(options);
  std::thread orders, out([&] {
    while (!ends) bridge.pass_out(kWait);
  });
  if (options.takes_goals) orders = std::thread([poses = bridge.poses(), &socket] { pass_orders(poses, socket); });
  while (!ends) bridge.pass_in(kWait);
  out.join();
  if (orders.joinable()) orders.join();
  bridge.stop();
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{
      "jaywalk_dds: a run's topics on DDS (rt/scan, rt/odom, rt/tf, rt/map, rt/plan, rt/tracks, rt/joint_states), or "
      "a robot's laser and base from it; with --goals, goals from rt/goal_pose, its place from rt/initialpose. Not yet "
      "tried with ROS 2 "
      "itself"};
  app.add_option("from", options.from,
                 "What a run with --view prints, http://127.0.0.1:PORT/ with its token; or ROBOT.toml with kind = "
                 "\"dds\" in [laser] or [drive]")
      ->required();
  app.add_flag("--goals", options.takes_goals,
               "Take goals and places: DDS asks nobody who he is, so that any program in the domain can send the robot "
               "anywhere");
  app.add_option("--fingerprint", options.fingerprint,
                 "Of the certificate behind an https:// address, as the run prints it: AB:CD:...");
  app.add_option("--namespace", options.space,
                 "Before a run's topics, /jaywalk say: where the robot has topics of these names itself")
      ->check([](const std::string& space) { return space.front() == '/' ? "" : "begins with a /"; });
  app.add_option("--socket", options.control_socket, "Of the run that goals go to, with ROBOT.toml");
  app.add_option("--domain", options.domain, "DDS domain; ROS 2's ROS_DOMAIN_ID")
      ->envname("ROS_DOMAIN_ID")
      ->check(CLI::Range(0, 232))
      ->capture_default_str();
  app.footer(
      "Examples:\n  jaywalk_dds http://127.0.0.1:8080/\n  jaywalk_dds robot.toml\nExit code: 0: ended by a signal, 2: "
      "bad input, or the run has ended");
  CLI11_PARSE(app, argc, argv);
  std::signal(SIGINT, [](int) { ends = true; });
  std::signal(SIGTERM, [](int) { ends = true; });
  try {
    options.from.ends_with(".toml") ? pass_robot_on(options) : pass_run_on(options);
  } catch (const StartupError& error) {
    std::fprintf(stderr, "jaywalk_dds: %s\n", error.what());
    return 2;
  }
  return 0;
}
