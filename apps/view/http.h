#pragma once
// As much of HTTP (RFC 9112) as a page and the upgrade to a WebSocket (RFC 6455, section 4) need.
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace jaywalk::view {

struct HttpRequest {
  std::string method;
  std::string path;                            ///< without the query
  std::string query;                           ///< behind the question mark
  std::map<std::string, std::string> headers;  ///< names in lower case, values without spaces round them
  [[nodiscard]] std::string header(const std::string& name) const;
};

/// A request whose head is complete (it ends in an empty line); nothing where it is no request.
[[nodiscard]] std::optional<HttpRequest> parse_request(std::string_view head);

/// A whole answer, after which the connection is closed. `status` as in "404 Not Found".
[[nodiscard]] std::string http_answer(std::string_view status, std::string_view type, std::string_view body);

/// The value of `name` in a query such as "a=1&token=2"; empty where it is not there.
[[nodiscard]] std::string query_value(std::string_view query, std::string_view name);

}  // namespace jaywalk::view
