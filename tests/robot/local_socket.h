#pragma once
// Local sockets: where a test's control socket is, and both ends of one.
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

#include "drivers/wire/file_descriptor.h"
#include "tests/support/catch.h"

namespace jaywalk::tests {

/// Path of a control socket, this process's own.
inline std::filesystem::path control_place() {
  return std::filesystem::temp_directory_path() / ("jaywalk_desk" + std::to_string(::getpid()) + ".sock");
}

inline sockaddr_un address_of(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  return address;
}

/// Socket of a `type` that is bound to a path, in place of what lies there.
inline wire::FileDescriptor bound_to(const std::filesystem::path& path, int type) {
  wire::FileDescriptor made(::socket(AF_UNIX, type, 0));
  const sockaddr_un address = address_of(path);
  std::filesystem::remove(path);
  REQUIRE(::bind(made.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  return made;
}

/// Client of the socket at a path, unless that has no room for it.
inline wire::FileDescriptor connected_to(const std::filesystem::path& path, int flags = 0) {
  wire::FileDescriptor made(::socket(AF_UNIX, SOCK_STREAM | flags, 0));
  const sockaddr_un address = address_of(path);
  static_cast<void>(::connect(made.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address));
  return made;
}

inline void say(const wire::FileDescriptor& peer, std::string_view text) {
  static_cast<void>(::send(peer.get(), text.data(), text.size(), MSG_NOSIGNAL));
}

/// Up to a thousand bytes that have come; with MSG_WAITALL all until the other end is closed.
inline std::string heard_by(const wire::FileDescriptor& peer, int flags = MSG_DONTWAIT) {
  std::string text(1000, '\0');
  const ssize_t got = ::recv(peer.get(), text.data(), text.size(), flags);
  text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return text;
}

}  // namespace jaywalk::tests
