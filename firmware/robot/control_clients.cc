#include "firmware/robot/control_clients.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace jaywalk {
namespace {

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

bool is_stop(std::string_view line) noexcept { return line.starts_with("stop"); }

}  // namespace

ControlClients::ControlClients(Answer answer) : answer_(std::move(answer)) { clients_.reserve(kMostClients + 1); }

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
  accept_new(listener, now);
  for (Client& client : clients_) read(client);
  answer_job();
  for (Client& client : clients_) {
    if (client.state == State::kAsked && is_stop(client.order())) answer(client);
  }
  std::size_t answers = 0;
  for (Client& client : clients_) {
    if (client.state == State::kAsked && answers++ < kMostAnswers) answer(client);
  }
  drop_done(now);
}

void ControlClients::accept_new(int listener, Time now) {
  for (std::size_t k = 0; k < kMostAccepted; ++k) {
    wire::FileDescriptor socket(::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (socket.get() < 0) return;
    if (clients_.size() == kMostClients) make_room();
    Client& client = clients_.emplace_back();
    client.process = process_of(socket.get());
    client.since = now;
    client.socket = std::move(socket);
  }
}

void ControlClients::make_room() {
  const auto held_by = [this](pid_t process) {
    return std::count_if(clients_.begin(), clients_.end(), [&](const Client& c) { return c.process == process; });
  };
  auto loser = clients_.begin();
  std::ptrdiff_t most = 0;
  for (auto client = clients_.begin(); client != clients_.end(); ++client) {
    if (client->state == State::kAwaitsJob) continue;
    const std::ptrdiff_t held = held_by(client->process);
    if (held > most) loser = client, most = held;
  }
  clients_.erase(loser);
}

void ControlClients::read(Client& client) noexcept {
  if (client.state != State::kTalks) return;
  char* const end = client.line.data() + client.length;
  const ssize_t got = ::recv(client.socket.get(), end, client.line.size() - client.length, 0);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (got <= 0) {
    client.state = State::kDone;  // went away before the end of its line
    return;
  }
  client.length += static_cast<std::size_t>(got);
  if (const void* newline = std::memchr(end, '\n', static_cast<std::size_t>(got)); newline != nullptr) {
    client.length = static_cast<std::size_t>(static_cast<const char*>(newline) - client.line.data());
    client.state = State::kAsked;
  } else if (client.length == client.line.size()) {
    send_to(client.socket.get(), "refused: too long a line\n");
    client.state = State::kDone;
  }
}

void ControlClients::answer(Client& client) {
  client.state = State::kDone;
  const ControlReply reply = answer_(client.order());
  if (reply.job && job_.valid()) {
    send_to(client.socket.get(), "refused: an earlier order is still being carried out; try again\n");
  } else if (reply.job) {
    start_job(client, reply.job);
  } else {
    send_to(client.socket.get(), reply.text);
  }
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
  std::erase_if(clients_, [now](const Client& client) {
    return client.state == State::kDone || (client.state == State::kTalks && now - client.since > kPatience);
  });
}

}  // namespace jaywalk
