#include "firmware/robot/control_socket.h"

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

#include "firmware/robot/realtime.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr Duration kLook = std::chrono::milliseconds(100);  ///< how often the thread sees whether it is to end
constexpr Duration kRound = std::chrono::milliseconds(5);   ///< at least, from one round to the next
constexpr int kBacklog = 512;                               ///< clients that may wait to be accepted

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

/// Connected, or -1 and errno. Gives up connecting, sending and receiving after three seconds each.
wire::FileDescriptor connected_to(const std::filesystem::path& path) {
  const sockaddr_un address = address_of(path);
  const timeval limit{.tv_sec = 3, .tv_usec = 0};
  wire::FileDescriptor made(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  ::setsockopt(made.get(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  ::setsockopt(made.get(), SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
  if (::connect(made.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return {};
  return made;
}

wire::FileDescriptor listening_at(const std::filesystem::path& path) {
  const sockaddr_un address = address_of(path);
  if (connected_to(path).get() >= 0) {
    throw StartupError(path.string() + ": another run listens there", "end it, or give control_socket another name");
  }
  ::unlink(address.sun_path);  // of a run that was killed
  wire::FileDescriptor made(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (::bind(made.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::chmod(address.sun_path, S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP) != 0 || ::listen(made.get(), kBacklog) != 0) {
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

ControlSocket::ControlSocket(std::filesystem::path path, Answer answer, int priority)
    : path_(std::move(path)), clients_(std::move(answer)), listener_(listening_at(path_)) {
  sigset_t all, before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this, priority] { serve(priority); });
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

ControlSocket::~ControlSocket() {
  ending_ = true;
  thread_.join();
  std::error_code gone;
  std::filesystem::remove(path_, gone);
}

void ControlSocket::serve(int priority) noexcept {
  static_cast<void>(enter_realtime({.priority = priority}));  // the loop's thread tells what is not permitted
  while (!ending_) {
    clients_.wait(listener_.get(), kLook);
    const auto began = std::chrono::steady_clock::now();
    clients_.serve(listener_.get(), Time{began.time_since_epoch()});
    std::this_thread::sleep_until(began + kRound);
  }
}

std::string ask(const std::filesystem::path& path, const std::string& line) {
  const wire::FileDescriptor run = connected_to(path);
  if (run.get() < 0) {
    throw StartupError(path.string() + ": no run listens there: " + std::strerror(errno),
                       "start one with jaywalk run, or name its socket with --socket");
  }
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
