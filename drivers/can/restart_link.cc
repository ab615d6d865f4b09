#include "drivers/can/restart_link.h"

#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

#include "drivers/wire/file_descriptor.h"

namespace jaywalk {

std::string restart_link(const std::string& interface) {
  ifreq request{};
  if (interface.size() >= sizeof request.ifr_name) return interface + ": no such interface";
  std::memcpy(request.ifr_name, interface.data(), interface.size());
  const wire::FileDescriptor any(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (::ioctl(any.get(), SIOCGIFFLAGS, &request) != 0) return interface + ": " + std::strerror(errno);
  for (const bool up : {false, true}) {
    const int flags = up ? request.ifr_flags | IFF_UP : request.ifr_flags & ~IFF_UP;
    request.ifr_flags = static_cast<decltype(request.ifr_flags)>(flags);
    if (::ioctl(any.get(), SIOCSIFFLAGS, &request) != 0) {
      return interface + ": not permitted to restart it: " + std::strerror(errno) + "; run as root, or: ip link set " +
             interface + " down && ip link set " + interface + " up";
    }
  }
  return "";
}

}  // namespace jaywalk
