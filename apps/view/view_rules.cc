#include "apps/view/view_rules.h"

#include <openssl/crypto.h>

#include <algorithm>
#include <map>

#include "apps/view/foxglove_session.h"

namespace jaywalk::view {
namespace {
constexpr std::chrono::seconds kStuck{1};

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
  if (!must) return std::nullopt;
  return static_cast<std::size_t>(worst - placed.begin());
}

}  // namespace jaywalk::view
