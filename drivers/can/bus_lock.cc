#include "drivers/can/bus_lock.h"

#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>

#include "hal/types/errors.h"

namespace jaywalk {

// An address that begins with a zero byte is in the abstract namespace: unix(7).
BusLock::BusLock(const std::string& interface) : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = "jaywalk-can:" + interface;
  const std::size_t length = std::min(name.size(), sizeof address.sun_path - 1);
  std::memcpy(address.sun_path + 1, name.data(), length);
  const auto bytes = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + length);
  if (::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), bytes) == 0) return;
  if (errno == EADDRINUSE) {
    throw StartupError(interface + ": another program of jaywalk has the drives on this bus",
                       "end it first: jaywalk status, or: ss -xp | grep " + name);
  }
  throw StartupError(interface + ": cannot be locked: " + std::strerror(errno), "see what this system forbids");
}

}  // namespace jaywalk
