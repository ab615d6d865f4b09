#pragma once
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/view/page_socket.h"

namespace jaywalk::view {

/// Clients that mean the live page's server no good, each of its kind, in a process of their own: what they need is not
/// counted as the server's. Each acts ten times a second; one that is turned away is back the next time.
class HostileProcess {
 public:
  /// To be made before any thread is.
  explicit HostileProcess(int clients) {
    int ends[2];
    if (::pipe(ends) != 0) std::abort();
    process_ = ::fork();
    orders_ = wire::FileDescriptor(ends[1]);
    const wire::FileDescriptor told(ends[0]);
    if (process_ != 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    orders_ = {};
    live(told.get(), clients);
    ::_exit(0);
  }
  ~HostileProcess() {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  HostileProcess(const HostileProcess&) = delete;
  HostileProcess& operator=(const HostileProcess&) = delete;

  /// `query` holds the token: some have stolen it.
  void begin(std::uint16_t port, const std::string& query) {
    const std::string line = std::to_string(port) + " " + query + "\n";
    if (::write(orders_.get(), line.data(), line.size()) < 0) std::abort();
  }

 private:
  static void live(int told, int clients) {
    char line[200] = {};
    if (::read(told, line, sizeof line - 1) <= 0) return;
    const std::string text(line), query = text.substr(text.find(' ') + 1, text.find('\n') - text.find(' ') - 1);
    const auto port = static_cast<std::uint16_t>(std::stoi(text));
    rlimit limit{};
    ::getrlimit(RLIMIT_NOFILE, &limit);
    limit.rlim_cur = limit.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &limit);
    std::vector<wire::FileDescriptor> peers(static_cast<std::size_t>(clients));
    for (std::size_t k = 0;; k = (k + 1) % peers.size()) {
      act(peers[k], k, port, query);
      if (k % 100 == 99 || k + 1 == peers.size()) ::usleep(static_cast<useconds_t>(1e5 * 100 / std::max(clients, 100)));
    }
  }

  /// Says what its kind says, first and again; reads nothing.
  static void act(wire::FileDescriptor& peer, std::size_t kind, std::uint16_t port, const std::string& query) {
    char byte = 0;
    const ssize_t got = peer.get() < 0 ? 0 : ::recv(peer.get(), &byte, 1, MSG_DONTWAIT | MSG_PEEK);
    const bool is_new = got == 0 || (got < 0 && errno != EAGAIN);
    if (is_new) peer = connected(port, SOCK_NONBLOCK);
    std::string subscribe = R"({"op":"subscribe","subscriptions":[)";
    for (int k = 0; k < 240; ++k) subscribe += R"({"id":7,"channelId":)" + std::to_string(k % 10) + "},";
    subscribe.back() = ']';
    const std::string unsubscribe = R"({"op":"unsubscribe","subscriptionIds":[7]})";
    std::string said;
    switch (kind % 8) {
      case 0: said = is_new ? "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n" : "X: y\r\n"; break;
      case 1: break;  // nothing
      case 2: said = std::string(500, '\xA5'); break;
      case 3: said = is_new ? request("GET /" + query) : ""; break;
      case 4:
        said = is_new ? upgrade("/" + query, "foxglove.websocket.v1") : frame(subscribe + "}") + frame(unsubscribe);
        break;
      case 5: said = is_new ? upgrade("/ws" + query) : frame(R"({"past":true})") + frame(R"({"goal":[1e9,0]})"); break;
      case 6: said = is_new ? upgrade("/ws") : frame(R"({"goal":[1,1]})"); break;
      case 7: said = is_new ? "POST /stop HTTP/1.1\r\nHost: x\r\nContent-Length: 8000\r\n\r\n" : "x"; break;
    }
    if (!said.empty()) static_cast<void>(::send(peer.get(), said.data(), said.size(), MSG_NOSIGNAL | MSG_DONTWAIT));
  }

  pid_t process_ = 0;
  wire::FileDescriptor orders_;
};

}  // namespace jaywalk::view
