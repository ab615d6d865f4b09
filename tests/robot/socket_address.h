#pragma once
#include <sys/socket.h>
#include <sys/un.h>

#include <cstring>
#include <filesystem>

namespace jaywalk::tests {

/// Address of the local socket at a path.
inline sockaddr_un address_of(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  return address;
}

}  // namespace jaywalk::tests
