#include "firmware/robot/control_socket.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "drivers/wire/thread_without_signals.h"
#include "firmware/robot/realtime.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr std::string_view kNow = "now";

struct StopWord {
  std::string_view word;
  StopWords means;
};
constexpr std::array kStopWords{StopWord{"stop", StopWords::kStop}, StopWord{"halt", StopWords::kStop},
                                StopWord{"emergency", StopWords::kStopNow}, StopWord{"estop", StopWords::kStopNow},
                                StopWord{"e-stop", StopWords::kStopNow}};

char lower(char c) noexcept { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool is_same(char a, char b) noexcept { return lower(a) == lower(b); }

StopWords stop_in_line(std::string_view line) noexcept {
  const auto* const letter =
      std::find_if(line.begin(), line.end(), [](char c) { return lower(c) >= 'a' && lower(c) <= 'z'; });
  line.remove_prefix(static_cast<std::size_t>(letter - line.begin()));
  const auto* const found = std::find_if(kStopWords.begin(), kStopWords.end(), [line](const StopWord& row) {
    return line.size() >= row.word.size() && std::equal(row.word.begin(), row.word.end(), line.begin(), is_same);
  });
  if (found == kStopWords.end()) return StopWords::kNone;
  const bool now = std::search(line.begin(), line.end(), kNow.begin(), kNow.end(), is_same) != line.end();
  return now ? StopWords::kStopNow : found->means;
}

constexpr Duration kWhileDue = std::chrono::milliseconds(20);  ///< how often a job is asked whether it is done

pid_t process_of(int socket) noexcept {
  ucred peer{};
  socklen_t size = sizeof peer;
  return ::getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 ? peer.pid : 0;
}

/// An answer is shorter than what the kernel keeps for a client that does not read; one that it refuses is lost.
void send_to(int socket, std::string_view text) noexcept {
  static_cast<void>(::send(socket, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT));
}

wire::FileDescriptor reserved() noexcept { return wire::FileDescriptor(::open("/dev/null", O_RDONLY | O_CLOEXEC)); }

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
  ::fchmod(made.get(), S_IRUSR | S_IWUSR);  // no other user can connect before the socket listens
  if (::bind(made.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::chmod(address.sun_path, S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP) != 0 || ::listen(made.get(), kBacklog) != 0)
    throw StartupError(path.string() + ": " + std::strerror(errno), "give control_socket a name that can be made");
  return made;
}

}  // namespace

StopWords stop_in(std::string_view text) noexcept {
  StopWords found = StopWords::kNone;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    found = std::max(found, stop_in_line(text.substr(at, end - at)));
    at = end + 1;
  }
  return found;
}

ControlClients::ControlClients(Answer answer) : answer_(std::move(answer)), reserve_(reserved()) {
  clients_.reserve(kMostClients + 1);
}

void ControlClients::wait(int listener, Duration longest) {
  std::array<pollfd, kMostClients + 1> watched;
  std::size_t count = 0;
  watched[count++] = {.fd = listener, .events = POLLIN, .revents = 0};
  for (const Client& client : clients_) {
    if (client.state == State::kAsked) return;  // there were too many for one round
    if (client.state == State::kTalks) watched[count++] = {.fd = client.socket.get(), .events = POLLIN, .revents = 0};
  }
  if (job_.valid()) longest = std::min(longest, kWhileDue);
  ::poll(watched.data(), count, static_cast<int>(longest / std::chrono::milliseconds(1)));
}

void ControlClients::serve(int listener, Time now) {
  for (Client& client : clients_) read(client);
  accept_new(listener, now);
  answer_job();
  std::size_t answers = 0;
  for (Client& client : clients_)
    if (client.state == State::kAsked && answers++ < kMostAnswers) answer(client);
  drop_done(now);
  if (reserve_.get() < 0) reserve_ = reserved();
}

void ControlClients::accept_new(int listener, Time now) {
  for (std::size_t k = 0; k < kMostAccepted; ++k) {
    wire::FileDescriptor socket = accepted(listener);
    if (socket.get() < 0) return;
    if (clients_.size() == kMostClients && !make_room()) return;
    Client& client = clients_.emplace_back();
    client.process = process_of(socket.get());
    client.since = now;
    client.socket = std::move(socket);
    read(client);
  }
}

wire::FileDescriptor ControlClients::accepted(int listener) {
  const auto accept = [listener] {
    return wire::FileDescriptor(::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
  };
  wire::FileDescriptor socket = accept();
  if (socket.get() >= 0 || (errno != EMFILE && errno != ENFILE)) return socket;
  if (!make_room()) reserve_ = {};
  return accept();
}

bool ControlClients::make_room() {
  std::array<pid_t, kMostClients> processes;
  const auto end = std::transform(clients_.begin(), clients_.end(), processes.begin(),
                                  [](const Client& client) { return client.process; });
  std::sort(processes.begin(), end);
  auto loser = clients_.end();
  std::ptrdiff_t most = 0;
  for (auto client = clients_.begin(); client != clients_.end(); ++client) {
    if (client->state == State::kAwaitsJob) continue;
    const auto [first, last] = std::equal_range(processes.begin(), end, client->process);
    const std::ptrdiff_t held = client->state == State::kDone ? std::ptrdiff_t{kMostClients} + 1 : last - first;
    if (held > most) loser = client, most = held;
  }
  if (loser == clients_.end()) return false;
  if (loser->state == State::kTalks) end_line(*loser, false);
  clients_.erase(loser);
  return true;
}

void ControlClients::read(Client& client) {
  if (client.state != State::kTalks) return;
  char* const end = client.text.data() + client.length;
  const ssize_t got = ::recv(client.socket.get(), end, client.text.size() - client.length, 0);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (got > 0) client.length += static_cast<std::size_t>(got);
  const std::size_t line = client.said().find('\n');
  if (got <= 0) return end_line(client, false);
  if (line < client.length || client.length > kLongestLine) end_line(client, line <= kLongestLine);
}

/// A stop among all that it said comes before what it said first.
void ControlClients::end_line(Client& client, bool whole) {
  client.state = State::kAsked;
  if (stop_in(client.said()) != StopWords::kNone) return answer(client);
  if (whole) return;
  if (client.length > kLongestLine) send_to(client.socket.get(), "refused: too long a line\n");
  client.state = State::kDone;
}

void ControlClients::answer(Client& client) {
  client.state = State::kDone;
  constexpr std::array<std::string_view, 3> kStops{"", "stop", "stop now"};
  const StopWords stop = stop_in(client.said());
  const std::string_view first = client.said().substr(0, client.said().find('\n'));
  const ControlReply reply = answer_(stop == StopWords::kNone ? first : kStops[static_cast<std::size_t>(stop)]);
  if (reply.job && job_.valid())
    send_to(client.socket.get(), "refused: an earlier order is still being carried out; try again\n");
  else if (reply.job)
    start_job(client, reply.job);
  else
    send_to(client.socket.get(), reply.text);
}

void ControlClients::start_job(Client& client, const std::function<std::string()>& job) {
  try {
    job_ = std::async(std::launch::async, job);
    client.state = State::kAwaitsJob;
  } catch (const std::system_error& error) {
    send_to(client.socket.get(), std::string("refused: no thread for it: ") + error.what() + "; try again\n");
  }
}

void ControlClients::answer_job() {
  if (!job_.valid() || job_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  const std::string text = job_.get();
  for (Client& client : clients_) {
    if (client.state != State::kAwaitsJob) continue;
    send_to(client.socket.get(), text);
    client.state = State::kDone;
  }
}

void ControlClients::drop_done(Time now) {
  for (Client& client : clients_)
    if (client.state == State::kTalks && now - client.since > kPatience) end_line(client, false);
  std::erase_if(clients_, [](const Client& client) { return client.state == State::kDone; });
}

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
  const std::string order = line + "\n";
  static_cast<void>(::send(run.get(), order.data(), order.size(), MSG_NOSIGNAL));
  std::string answer;
  std::array<char, 1024> part{};
  for (ssize_t got = 0; (got = ::recv(run.get(), part.data(), part.size(), 0)) > 0;)
    answer.append(part.data(), static_cast<std::size_t>(got));
  if (answer.empty()) throw StartupError(path.string() + ": no answer", "see whether the run has stopped or hangs");
  return answer;
}

}  // namespace jaywalk
