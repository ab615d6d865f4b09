#include "drivers/wire/endpoint.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <termios.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

#include "drivers/wire/serial_settings.h"
#include "hal/types/errors.h"

namespace jaywalk::wire {

namespace {

constexpr std::uint32_t kSlowestBaud = 50, kFastestBaud = 4'000'000;

}  // namespace

TcpEndpoint::TcpEndpoint(const std::string& host, std::uint16_t port) : name_(host + ":" + std::to_string(port)) {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  int failure = 0;
  for (const int family : {AF_INET, AF_INET6}) {  // the older first: that is what devices have
    wanted.ai_family = family;
    failure = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wanted, &found);
    if (failure == 0) break;
  }
  if (failure != 0) {
    throw StartupError(name_ + ": no such host (" + ::gai_strerror(failure) + ")",
                       "give the device's address, and see that the network is up");
  }
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, &::freeaddrinfo);
  std::memcpy(&address_, found->ai_addr, std::min<std::size_t>(found->ai_addrlen, sizeof address_));
  address_size_ = found->ai_addrlen;
}

FileDescriptor TcpEndpoint::open() const noexcept {
  FileDescriptor made(::socket(address_.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (made.get() < 0) return made;
  const int on = 1;
  static_cast<void>(::setsockopt(made.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on));
  const auto* const address = reinterpret_cast<const sockaddr*>(&address_);
  if (::connect(made.get(), address, address_size_) == 0 || errno == EINPROGRESS) return made;
  return FileDescriptor();
}

SerialEndpoint::SerialEndpoint(std::string path, std::uint32_t baud) : path_(std::move(path)), baud_(baud) {
  if (baud < kSlowestBaud || baud > kFastestBaud) {
    throw StartupError(path_ + ": no serial line runs at " + std::to_string(baud) + " baud",
                       "give the rate in the device's manual, for example 115200");
  }
}

FileDescriptor SerialEndpoint::open() const noexcept {
  FileDescriptor line(::open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (line.get() < 0 || !set_raw(line.get(), baud_)) return FileDescriptor();
  static_cast<void>(::tcflush(line.get(), TCIFLUSH));
  return line;
}

}  // namespace jaywalk::wire
