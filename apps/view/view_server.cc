#include "apps/view/view_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <sys/random.h>
#include <sys/socket.h>

#include <vector>

#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk::view {
namespace {

constexpr std::size_t kMostClients = 8;  ///< others are turned away
constexpr int kLookEvery_ms = 10;        ///< a frame waits this long at most: little beside the 40 ms between frames

std::string made_token() {
  unsigned char bytes[16];
  if (::getrandom(bytes, sizeof bytes, 0) != sizeof bytes)
    throw StartupError("no random numbers for the page's token", "serve it on 127.0.0.1");
  std::string token;
  for (const unsigned char byte : bytes)
    token += "0123456789abcdef"[byte >> 4U], token += "0123456789abcdef"[byte & 15U];
  return token;
}

in_addr parsed(const std::string& address) {
  in_addr out{};
  if (::inet_pton(AF_INET, address.c_str(), &out) != 1)
    throw StartupError("--view-address " + shown(address) + ": no IPv4 address",
                       "give one of this machine's, such as 127.0.0.1; 0.0.0.0 serves all of them");
  return out;
}

}  // namespace

ViewServer::ViewServer(const ViewAddress& where, ViewDoor door) : address_(where.address), said_(door.channels.size()) {
  rules_.on_order = std::move(door.on_order);
  rules_.channels = std::move(door.channels);
  rules_.origin = where.origin;
  rules_.loopback = where.address == "127.0.0.1";
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr = parsed(where.address);
  at.sin_port = htons(where.port);
  if (!rules_.loopback) rules_.token = made_token();
  listener_ = wire::FileDescriptor(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int on = 1;
  static_cast<void>(::setsockopt(listener_.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on));
  auto* const any = reinterpret_cast<sockaddr*>(&at);
  socklen_t size = sizeof at;
  if (::bind(listener_.get(), any, size) != 0 || ::listen(listener_.get(), 4) != 0 ||
      ::getsockname(listener_.get(), any, &size) != 0) {
    throw StartupError("--view: " + address_ + ":" + std::to_string(where.port) + " cannot be served",
                       "end what listens there, or give another port (--view alone takes a free one)");
  }
  port_ = ntohs(at.sin_port);
  thread_ = std::thread([this] { run(); });
}

ViewServer::~ViewServer() {
  ends_ = true;
  thread_.join();
}

std::string ViewServer::url() const {
  std::string url = "http://" + address_ + ":" + std::to_string(port_) + "/";
  return rules_.token.empty() ? url : url + "?token=" + rules_.token;
}

void ViewServer::push(MessageKind kind, std::string text) {
  ViewMessage* const slot = ring_.draft();
  if (slot == nullptr) return;
  *slot = {.kind = kind, .text = std::move(text)};
  ring_.publish();
}

void ViewServer::push(std::size_t channel, Time stamp, std::string message) {
  ViewMessage* const slot = ring_.draft();
  if (slot == nullptr) return;
  *slot = {.kind = MessageKind::kTopic, .text = std::move(message), .channel = channel, .stamp = stamp};
  ring_.publish();
}

void ViewServer::run() {
  sigset_t all;
  sigfillset(&all);
  ::pthread_sigmask(SIG_BLOCK, &all, nullptr);  // signals are for the thread that drives
  const sched_param ordinary{};
  static_cast<void>(::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &ordinary));  // whatever its maker has
  static_cast<void>(::pthread_setname_np(::pthread_self(), "view"));
  while (!ends_) {
    std::vector<pollfd> watched{{listener_.get(), POLLIN, 0}};
    for (const ViewClient& client : clients_)
      watched.push_back({client.socket(), static_cast<short>(client.has_unsent() ? POLLIN | POLLOUT : POLLIN), 0});
    static_cast<void>(::poll(watched.data(), watched.size(), kLookEvery_ms));
    accept_newcomers();
    pass_on();
    serve_clients();
    count_clients();
  }
  pass_on();
  serve_clients();
}

void ViewServer::accept_newcomers() {
  wire::FileDescriptor peer(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (peer.get() < 0 || clients_.size() >= kMostClients) return;
  const int on = 1;
  static_cast<void>(::setsockopt(peer.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on));
  clients_.emplace_back(std::move(peer), rules_);
}

void ViewServer::pass_on() {
  for (const ViewMessage* m = ring_.front(); m != nullptr; m = ring_.front()) {
    if (m->kind == MessageKind::kHello) hello_ = m->text;
    if (m->kind == MessageKind::kField) field_ = m->text;
    if (m->kind == MessageKind::kTopic) said_[m->channel] = *m;
    for (ViewClient& client : clients_) hand(*m, client);
    ring_.pop();
  }
}

void ViewServer::hand(const ViewMessage& m, ViewClient& client) {
  if (m.kind == MessageKind::kTopic) return client.offer(m.channel, m.stamp, m.text);
  m.kind == MessageKind::kEnd ? client.queue(m.text) : client.offer(m.text);
}

void ViewServer::serve_clients() {
  const auto now = ViewClient::Clock::now();
  std::erase_if(clients_, [this, now](ViewClient& client) {
    if (!client.serve(now)) return true;
    welcome(client);
    return false;
  });
}

void ViewServer::welcome(ViewClient& client) {
  if (client.has_joined()) {
    for (const std::string* kept : {&hello_, &field_})
      if (!kept->empty()) client.queue(*kept);
  }
  for (const std::size_t channel : client.subscribed()) {
    if (const ViewMessage& said = said_[channel]; said.stamp != kNever) client.queue(channel, said.stamp, said.text);
  }
}

void ViewServer::count_clients() {
  int viewers = 0;
  bool pages = false;
  std::uint32_t wanted = 0;
  for (const ViewClient& client : clients_) {
    wanted |= client.wanted();
    pages = pages || client.is_page();
    viewers += client.is_page() || client.wanted() != 0 ? 1 : 0;
  }
  viewers_ = viewers;
  has_pages_ = pages;
  wanted_ = wanted;
}

}  // namespace jaywalk::view
