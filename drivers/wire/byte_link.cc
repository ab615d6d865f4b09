#include "drivers/wire/byte_link.h"

#include <poll.h>

#include <cerrno>
#include <ctime>

namespace jaywalk::wire {

void ByteLink::open() noexcept {
  file_ = endpoint_->open();
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
  if (failed) {
    close();
  } else {
    state_ = State::kOpen;
  }
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
  if (host.empty()) return std::make_unique<ByteLink>(std::make_unique<SerialEndpoint>(device, baud));
  return std::make_unique<ByteLink>(std::make_unique<TcpEndpoint>(host, port));
}

}  // namespace jaywalk::wire
