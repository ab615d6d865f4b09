#include "apps/view/http.h"

#include <algorithm>
#include <cctype>

namespace jaywalk::view {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

/// "GET /path?query HTTP/1.1"
bool read_request_line(std::string_view line, HttpRequest& request) {
  const auto space = line.find(' ');
  const auto last = line.rfind(' ');
  if (space == std::string_view::npos || last <= space || line.substr(last + 1).substr(0, 7) != "HTTP/1.") return false;
  const std::string_view target = line.substr(space + 1, last - space - 1);
  const auto mark = target.find('?');
  request.method = line.substr(0, space);
  request.path = target.substr(0, mark);
  if (mark != std::string_view::npos) request.query = target.substr(mark + 1);
  return true;
}

}  // namespace

std::string HttpRequest::header(const std::string& name) const {
  const auto found = headers.find(name);
  return found == headers.end() ? "" : found->second;
}

std::optional<HttpRequest> parse_request(std::string_view head) {
  HttpRequest request;
  bool first = true;
  while (!head.empty()) {
    const auto end = head.find("\r\n");
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view line = head.substr(0, end);
    head.remove_prefix(end + 2);
    if (line.empty()) break;
    const auto colon = line.find(':');
    if (first ? !read_request_line(line, request) : colon == std::string_view::npos) return std::nullopt;
    if (!first) request.headers[lower(line.substr(0, colon))] = trimmed(line.substr(colon + 1));
    first = false;
  }
  return first ? std::nullopt : std::optional(request);
}

std::string http_answer(std::string_view status, std::string_view type, std::string_view body) {
  std::string answer = "HTTP/1.1 " + std::string(status) + "\r\nContent-Type: " + std::string(type);
  answer += "\r\nContent-Length: " + std::to_string(body.size());
  answer += "\r\nConnection: close\r\nX-Frame-Options: DENY\r\nReferrer-Policy: no-referrer\r\n\r\n";
  return answer += body;
}

std::string query_value(std::string_view query, std::string_view name) {
  while (!query.empty()) {
    const std::string_view part = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(query.size(), part.size() + 1));
    if (part.size() > name.size() && part.substr(0, name.size()) == name && part[name.size()] == '=')
      return std::string(part.substr(name.size() + 1));
  }
  return "";
}

}  // namespace jaywalk::view
