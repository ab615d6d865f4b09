#include "firmware/robot/control_socket.h"

#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/un.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr int kLook_ms = 100;  ///< how often the thread sees whether it is to end

sockaddr_un address_of(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string text = path.string();
  if (text.empty() || text.size() >= sizeof address.sun_path) {
    throw StartupError(text + ": no name for a socket", "choose one of 1 to 107 characters");
  }
  std::memcpy(address.sun_path, text.data(), text.size());
  return address;
}

/// Connected, or -1 and errno.
wire::FileDescriptor connected_to(const std::filesystem::path& path) {
  const sockaddr_un address = address_of(path);
  wire::FileDescriptor made(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (::connect(made.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return {};
  return made;
}

void be_patient(int socket, int seconds) {
  const timeval limit{.tv_sec = seconds, .tv_usec = 0};
  ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  ::setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
}

wire::FileDescriptor listening_at(const std::filesystem::path& path) {
  const sockaddr_un address = address_of(path);
  if (connected_to(path).get() >= 0) {
    throw StartupError(path.string() + ": another run listens there", "end it, or give control_socket another name");
  }
  ::unlink(address.sun_path);  // of a run that was killed
  wire::FileDescriptor made(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (::bind(made.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::chmod(address.sun_path, S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP) != 0 || ::listen(made.get(), 4) != 0) {
    throw StartupError(path.string() + ": " + std::strerror(errno), "give control_socket a name that can be made");
  }
  return made;
}

void say(int socket, std::string_view text) {
  while (!text.empty()) {
    const ssize_t sent = ::send(socket, text.data(), text.size(), MSG_NOSIGNAL);
    if (sent <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(sent));
  }
}

}  // namespace

std::filesystem::path default_control_socket() {
  if (const char* named = std::getenv("JAYWALK_SOCKET")) return named;
  if (const char* folder = std::getenv("XDG_RUNTIME_DIR")) return std::filesystem::path(folder) / "jaywalk.sock";
  return std::filesystem::temp_directory_path() / "jaywalk.sock";
}

ControlSocket::ControlSocket(std::filesystem::path path, Answer answer)
    : path_(std::move(path)), answer_(std::move(answer)), listener_(listening_at(path_)) {
  sigset_t all, before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { serve(); });
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

ControlSocket::~ControlSocket() {
  ending_ = true;
  thread_.join();
  std::error_code gone;
  std::filesystem::remove(path_, gone);
}

void ControlSocket::serve() noexcept {
  while (!ending_) {
    pollfd waiting{.fd = listener_.get(), .events = POLLIN, .revents = 0};
    if (::poll(&waiting, 1, kLook_ms) <= 0) continue;
    const wire::FileDescriptor peer(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (peer.get() >= 0) talk(peer.get());
  }
}

void ControlSocket::talk(int peer) noexcept {
  be_patient(peer, 1);
  std::array<char, kLongestLine + 1> line{};
  std::size_t length = 0;
  while (length < line.size()) {
    const ssize_t got = ::recv(peer, line.data() + length, line.size() - length, 0);
    if (got <= 0) return;  // went away, or does not come to the end of its line
    const void* end = std::memchr(line.data() + length, '\n', static_cast<std::size_t>(got));
    length += static_cast<std::size_t>(got);
    if (end == nullptr) continue;
    const auto until = static_cast<std::size_t>(static_cast<const char*>(end) - line.data());
    say(peer, answer_({line.data(), until}));
    return;
  }
  say(peer, "refused: too long a line\n");
}

std::string ask(const std::filesystem::path& path, const std::string& line) {
  const wire::FileDescriptor run = connected_to(path);
  if (run.get() < 0) {
    throw StartupError(path.string() + ": no run listens there: " + std::strerror(errno),
                       "start one with jaywalk run, or name its socket with --socket");
  }
  be_patient(run.get(), 3);
  say(run.get(), line + "\n");
  std::string answer;
  std::array<char, 1024> part{};
  for (ssize_t got = 0; (got = ::recv(run.get(), part.data(), part.size(), 0)) > 0;) {
    answer.append(part.data(), static_cast<std::size_t>(got));
  }
  if (answer.empty()) throw StartupError(path.string() + ": no answer", "see whether the run has stopped or hangs");
  return answer;
}

}  // namespace jaywalk
