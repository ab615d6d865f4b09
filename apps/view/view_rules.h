#pragma once
// Rules of the live page's server: requests it answers, places of clients, messages that wait. None needs a connection.
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

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

}  // namespace jaywalk::view
