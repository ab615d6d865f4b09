#pragma once
// What a request at the live page's server may have. Pure: no connection is needed to judge one.
#include <cstdint>
#include <string>
#include <string_view>

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

}  // namespace jaywalk::view
