#include "hil/emulators/byte_server.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <termios.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <utility>

#include "hal/types/errors.h"

namespace jaywalk::emulators {
namespace {

constexpr std::size_t kMostUnsent = 65536;

}  // namespace

bool ByteServer::has_peer() noexcept {
  wire::FileDescriptor newcomer = accept();
  if (newcomer.get() >= 0) {
    peer_ = std::move(newcomer);
    unsent_.clear();
    ++peers_;
  }
  return peer_.get() >= 0;
}

wire::Bytes ByteServer::read() noexcept {
  if (peer_.get() < 0) return {};
  const ssize_t count = ::read(peer_.get(), room_.data(), room_.size());
  if (count > 0) return wire::Bytes(room_).first(static_cast<std::size_t>(count));
  if (count == 0 || (errno != EAGAIN && errno != EINTR)) peer_ = wire::FileDescriptor();
  return {};
}

void ByteServer::write(wire::Bytes bytes) {
  if (peer_.get() < 0) return;
  if (unsent_.size() + bytes.size() <= kMostUnsent) unsent_.insert(unsent_.end(), bytes.begin(), bytes.end());
  ssize_t sent = ::send(peer_.get(), unsent_.data(), unsent_.size(), MSG_NOSIGNAL);
  const bool is_line = sent < 0 && errno == ENOTSOCK;
  if (is_line) sent = ::write(peer_.get(), unsent_.data(), unsent_.size());
  if (sent > 0) unsent_.erase(unsent_.begin(), unsent_.begin() + sent);
  if (is_line) unsent_.clear();  // a serial line does not wait for a reader
}

void ByteServer::drop_peer() noexcept {
  const linger at_once{1, 0};  // makes close send a reset; nothing on a serial line
  static_cast<void>(::setsockopt(peer_.get(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once));
  peer_ = wire::FileDescriptor();
}

void TcpServer::listen() {
  wire::FileDescriptor made(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int on = 1;
  static_cast<void>(::setsockopt(made.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  address.sin_port = htons(port_);
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  socklen_t size = sizeof address;
  if (::bind(made.get(), any, size) != 0 || ::listen(made.get(), 4) != 0 ||
      ::getsockname(made.get(), any, &size) != 0) {
    throw StartupError("port " + std::to_string(port_) + ": cannot be served",
                       "end what listens there, or take another");
  }
  port_ = ntohs(address.sin_port);
  listener_ = std::move(made);
}

wire::FileDescriptor TcpServer::accept() noexcept {
  if (listener_.get() < 0) return wire::FileDescriptor();
  wire::FileDescriptor peer(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  const int on = 1;
  if (peer.get() >= 0) static_cast<void>(::setsockopt(peer.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on));
  return peer;
}

void TcpServer::set_present(bool present) {
  if (present == (listener_.get() >= 0)) return;
  if (present) return listen();
  drop_peer();
  listener_ = wire::FileDescriptor();
}

void PtyServer::plug_in() {
  wire::FileDescriptor mine(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  std::array<char, 128> name{};
  if (mine.get() < 0 || ::grantpt(mine.get()) != 0 || ::unlockpt(mine.get()) != 0 ||
      ::ptsname_r(mine.get(), name.data(), name.size()) != 0)
    throw StartupError(path_ + ": no pseudo terminal for it", "mount /dev/pts");
  wire::FileDescriptor theirs(::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  termios settings{};
  if (theirs.get() < 0 || ::tcgetattr(theirs.get(), &settings) != 0)
    throw StartupError(path_ + ": " + name.data() + " cannot be opened", "mount /dev/pts");
  ::cfmakeraw(&settings);  // or what is sent comes back as an echo
  ::tcsetattr(theirs.get(), TCSANOW, &settings);
  std::error_code failure;
  std::filesystem::remove(path_, failure);
  std::filesystem::create_symlink(name.data(), path_, failure);
  if (failure)
    throw StartupError(path_ + ": cannot be made (" + failure.message() + ")", "choose a folder that is yours");
  fresh_ = std::move(mine);
  other_ = std::move(theirs);
}

void PtyServer::set_present(bool present) {
  if (present == (other_.get() >= 0)) return;
  if (present) return plug_in();
  drop_peer();
  fresh_ = wire::FileDescriptor();
  other_ = wire::FileDescriptor();
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace jaywalk::emulators
