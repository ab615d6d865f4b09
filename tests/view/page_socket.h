#pragma once
// A client of the live page's server, byte by byte.
#include <arpa/inet.h>
#include <sys/socket.h>

#include <string>
#include <string_view>

#include "drivers/wire/file_descriptor.h"

namespace jaywalk::view {

inline wire::FileDescriptor connected(std::uint16_t port, int flags = 0) {
  wire::FileDescriptor made(::socket(AF_INET, SOCK_STREAM | flags, 0));
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(port);
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  static_cast<void>(::connect(made.get(), reinterpret_cast<const sockaddr*>(&at), sizeof at));
  return made;
}

inline void say(const wire::FileDescriptor& peer, std::string_view text) {
  static_cast<void>(::send(peer.get(), text.data(), text.size(), MSG_NOSIGNAL));
}

/// What comes until the connection ends or the text holds `end`.
inline std::string heard(const wire::FileDescriptor& peer, std::string_view end = "\xFF\xFF") {
  std::string text, part(4096, '\0');
  while (text.find(end) == std::string::npos) {
    const ssize_t got = ::recv(peer.get(), part.data(), part.size(), 0);
    if (got <= 0) break;
    text.append(part, 0, static_cast<std::size_t>(got));
  }
  return text;
}

inline std::string request(std::string_view first_line, std::string_view headers = "") {
  return std::string(first_line) + " HTTP/1.1\r\nHost: 127.0.0.1\r\n" + std::string(headers) + "\r\n";
}

inline std::string upgrade(std::string_view target, std::string_view subprotocol = "") {
  std::string headers = "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n";
  if (!subprotocol.empty()) headers += "Sec-WebSocket-Protocol: " + std::string(subprotocol) + "\r\n";
  return request("GET " + std::string(target), headers + "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n");
}

/// A text as a client's frame (RFC 6455, section 5.2), masked with zeros; up to 65,535 bytes.
inline std::string frame(std::string_view text) {
  std::string out = "\x81";
  if (text.size() < 126) {
    out += static_cast<char>(0x80U | text.size());
  } else {
    out += {'\xFE', static_cast<char>(text.size() >> 8U), static_cast<char>(text.size() & 0xFFU)};
  }
  return out.append(4, '\0').append(text);
}

/// "http://127.0.0.1:8080/?token=ab": its port, and what stands behind the last slash.
inline std::uint16_t port_of(const std::string& url) {
  return static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
}
inline std::string query_of(const std::string& url) { return url.substr(url.find('/', 8) + 1); }

}  // namespace jaywalk::view
