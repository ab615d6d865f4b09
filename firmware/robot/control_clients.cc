#include "firmware/robot/control_clients.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace jaywalk {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f", kNow = "now";

struct StopWord {
  std::string_view word;
  StopWords means;
};
constexpr std::array kStopWords{StopWord{"stop", StopWords::kStop}, StopWord{"halt", StopWords::kStop},
                                StopWord{"emergency", StopWords::kStopNow}, StopWord{"estop", StopWords::kStopNow},
                                StopWord{"e-stop", StopWords::kStopNow}};

char lower(char c) noexcept { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool is_same(char said, char want) noexcept { return lower(said) == want; }

bool begins_with(std::string_view line, std::string_view word) noexcept {
  return line.size() >= word.size() &&
         std::equal(word.begin(), word.end(), line.begin(), [](char want, char said) { return is_same(said, want); });
}

StopWords stop_in_line(std::string_view line) noexcept {
  const auto* const letter =
      std::find_if(line.begin(), line.end(), [](char c) { return lower(c) >= 'a' && lower(c) <= 'z'; });
  line.remove_prefix(static_cast<std::size_t>(letter - line.begin()));
  const auto* const found = std::find_if(kStopWords.begin(), kStopWords.end(),
                                         [line](const StopWord& row) { return begins_with(line, row.word); });
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

}  // namespace

std::string_view trimmed(std::string_view line) noexcept {
  const std::size_t begin = line.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return line.substr(begin, line.find_last_not_of(kBlanks) - begin + 1);
}

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

}  // namespace jaywalk
