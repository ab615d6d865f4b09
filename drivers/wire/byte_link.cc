#include "drivers/wire/byte_link.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <termios.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "hal/types/errors.h"

namespace jaywalk::wire {
namespace {

constexpr std::uint32_t kSlowestBaud = 50, kFastestBaud = 4'000'000;

FileDescriptor open_socket(const sockaddr_storage& address, socklen_t size) noexcept {
  FileDescriptor made(::socket(address.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (made.get() < 0) return made;
  const int on = 1;
  static_cast<void>(::setsockopt(made.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on));
  if (::connect(made.get(), reinterpret_cast<const sockaddr*>(&address), size) == 0 || errno == EINPROGRESS)
    return made;
  return FileDescriptor();
}

FileDescriptor open_line(const std::string& path, std::uint32_t baud) noexcept {
  FileDescriptor line(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (line.get() < 0 || !set_raw(line.get(), baud)) return FileDescriptor();
  static_cast<void>(::tcflush(line.get(), TCIFLUSH));
  return line;
}

}  // namespace

Endpoint tcp_endpoint(const std::string& host, std::uint16_t port) {
  const std::string name = host + ":" + std::to_string(port);
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
    throw StartupError(name + ": no such host (" + ::gai_strerror(failure) + ")",
                       "give the device's address, and see that the network is up");
  }
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, &::freeaddrinfo);
  sockaddr_storage address{};
  std::memcpy(&address, found->ai_addr, std::min<std::size_t>(found->ai_addrlen, sizeof address));
  return {name, [address, size = found->ai_addrlen] { return open_socket(address, size); }};
}

Endpoint serial_endpoint(const std::string& path, std::uint32_t baud) {
  if (baud < kSlowestBaud || baud > kFastestBaud) {
    throw StartupError(path + ": no serial line runs at " + std::to_string(baud) + " baud",
                       "give the rate in the device's manual, for example 115200");
  }
  return {path, [path, baud] { return open_line(path, baud); }};
}

void ByteLink::open() noexcept {
  file_ = endpoint_.open();
  state_ = file_.get() < 0 ? State::kClosed : State::kOpening;
}

void ByteLink::close() noexcept {
  file_ = FileDescriptor();
  state_ = State::kClosed;
}

ByteLink::State ByteLink::state() noexcept {
  if (state_ != State::kOpening) return state_;
  pollfd writable{file_.get(), POLLOUT, 0};
  if (::poll(&writable, 1, 0) == 0) return state_;
  int failure = 0;
  socklen_t size = sizeof failure;
  const bool is_socket = ::getsockopt(file_.get(), SOL_SOCKET, SO_ERROR, &failure, &size) == 0;
  const bool failed = is_socket ? failure != 0 : (writable.revents & POLLOUT) == 0;
  if (failed)
    close();
  else
    state_ = State::kOpen;
  return state_;
}

Bytes ByteLink::read(std::span<std::uint8_t> room) noexcept {
  if (state_ != State::kOpen) return {};
  const ssize_t count = ::read(file_.get(), room.data(), room.size());
  if (count > 0) return room.first(static_cast<std::size_t>(count));
  const bool nothing_yet = count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
  if (!nothing_yet) close();
  return {};
}

void ByteLink::write(Bytes bytes) noexcept {
  if (state_ != State::kOpen || bytes.empty()) return;
  ssize_t sent = ::send(file_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
  if (sent < 0 && errno == ENOTSOCK) sent = ::write(file_.get(), bytes.data(), bytes.size());
  if (sent != static_cast<ssize_t>(bytes.size())) close();
}

void ByteLink::wait(Duration most) noexcept {
  const auto ms = static_cast<int>(std::chrono::duration_cast<std::chrono::milliseconds>(most).count());
  pollfd waited{file_.get(), static_cast<short>(state_ == State::kOpening ? POLLOUT : POLLIN), 0};
  static_cast<void>(::poll(&waited, state_ == State::kClosed ? 0 : 1, ms));
}

std::unique_ptr<Link> make_byte_link(const std::string& host, std::uint16_t port, const std::string& device,
                                     std::uint32_t baud) {
  if (host.empty()) return std::make_unique<ByteLink>(serial_endpoint(device, baud));
  return std::make_unique<ByteLink>(tcp_endpoint(host, port));
}

}  // namespace jaywalk::wire
