#include "firmware/robot/control_socket.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "drivers/wire/thread_without_signals.h"
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
  if (text.empty() || text.size() >= sizeof address.sun_path)
    throw StartupError(text + ": no name for a socket", "choose one of 1 to 107 characters");
  std::memcpy(address.sun_path, text.data(), text.size());
  return address;
}

/// Connected, or -1 and errno. Gives up connecting, sending and receiving after `limit_s` each.
wire::FileDescriptor connected_to(const std::filesystem::path& path, time_t limit_s = 3) {
  const sockaddr_un address = address_of(path);
  const timeval limit{.tv_sec = limit_s, .tv_usec = 0};
  wire::FileDescriptor made(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  ::setsockopt(made.get(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  ::setsockopt(made.get(), SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
  if (::connect(made.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return {};
  return made;
}

/// 0: there is no socket.
ino_t inode_of(const std::filesystem::path& path) noexcept {
  struct stat there {};
  return ::lstat(path.c_str(), &there) == 0 && S_ISSOCK(there.st_mode) ? there.st_ino : 0;
}

/// Of a run that was killed. Whatever else has that name is kept.
void remove_dead_socket(const std::filesystem::path& path) {
  struct stat there {};
  if (::lstat(path.c_str(), &there) != 0) return;
  if (!S_ISSOCK(there.st_mode) || (there.st_uid != ::geteuid() && ::geteuid() != 0)) {
    throw StartupError(path.string() + ": is there, and no socket of this user's",
                       "give control_socket or --socket another name");
  }
  ::unlink(path.c_str());
}

wire::FileDescriptor listening_at(const std::filesystem::path& path) {
  const sockaddr_un address = address_of(path);
  if (connected_to(path).get() >= 0)
    throw StartupError(path.string() + ": another run listens there", "end it, or give control_socket another name");
  remove_dead_socket(path);
  wire::FileDescriptor made(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  ::fchmod(made.get(), S_IRUSR | S_IWUSR);  // as long as it is not listening, nobody else's
  if (::bind(made.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::chmod(address.sun_path, S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP) != 0 || ::listen(made.get(), kBacklog) != 0)
    throw StartupError(path.string() + ": " + std::strerror(errno), "give control_socket a name that can be made");
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
    : path_(std::move(path)), clients_(std::move(answer)), listener_(listening_at(path_)), inode_(inode_of(path_)) {
  thread_ = thread_without_signals("orders", [this, priority] { serve(priority); });
}

ControlSocket::~ControlSocket() {
  ending_ = true;
  thread_.join();
  if (inode_of(path_) == inode_) ::unlink(path_.c_str());  // and no other file by then
}

void ControlSocket::serve(int priority) noexcept {
  static_cast<void>(enter_realtime({.priority = priority}));  // the loop's thread tells what is not permitted
  while (!ending_) {
    clients_.wait(listener_.get(), kLook);
    const auto began = std::chrono::steady_clock::now();
    clients_.serve(listener_.get(), Time{began.time_since_epoch()});
    const auto ended = std::chrono::steady_clock::now();
    std::this_thread::sleep_until(std::max(began + kRound, ended + (ended - began)));  // half a processor at most
  }
}

std::string ask(const std::filesystem::path& path, const std::string& line) {
  constexpr time_t kSearch_s = 20;  // for a place the run may search its map (OperatorDesk::answer_to_place())
  const wire::FileDescriptor run = line.starts_with("here ") ? connected_to(path, kSearch_s) : connected_to(path);
  if (run.get() < 0) {
    throw StartupError(path.string() + ": no run listens there: " + std::strerror(errno),
                       "start one with jaywalk run, or name its socket with --socket");
  }
  say(run.get(), line + "\n");
  std::string answer;
  std::array<char, 1024> part{};
  for (ssize_t got = 0; (got = ::recv(run.get(), part.data(), part.size(), 0)) > 0;)
    answer.append(part.data(), static_cast<std::size_t>(got));
  if (answer.empty()) throw StartupError(path.string() + ": no answer", "see whether the run has stopped or hangs");
  return answer;
}

}  // namespace jaywalk
