#include "apps/view/view_server.h"

#include <fcntl.h>
#include <pthread.h>
#include <signal.h>

#include <algorithm>
#include <utility>

#include "apps/view/secret.h"
#include "apps/view/view_client.h"
#include "firmware/robot/service_manager.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk::view {
namespace {
namespace asio = boost::asio;
using Tcp = asio::ip::tcp;
using Error = boost::system::error_code;

constexpr std::chrono::milliseconds kTick{10};       ///< little beside the 40 ms between frames
constexpr std::chrono::milliseconds kFarewell{500};  ///< at the end, for what is not sent yet
constexpr int kAcceptedAtOnce = 8;  ///< few, so that what they ask is read before their place may go to others
constexpr int kBacklog = 1024;

Tcp::endpoint parsed(const ViewAddress& where) {
  Error none;
  const auto address = asio::ip::make_address_v4(where.address, none);
  if (none)
    throw StartupError("--view-address " + shown(where.address) + ": no IPv4 address",
                       "give one of this machine's, such as 127.0.0.1; 0.0.0.0 serves all of them");
  return {address, where.port};
}

}  // namespace

BeastServer::BeastServer(const ViewAddress& where, ViewDoor asked) : said_(asked.channels.size()) {
  door = std::move(asked);
  rules = {.origin = where.origin, .loopback = where.address == "127.0.0.1"};
  const Tcp::endpoint at = parsed(where);
  if (!rules.loopback || where.wants_token) rules.token = made_token();
  if (!rules.loopback) {
    tls = tls_context(where.certificate);
    fingerprint_ = fingerprint_of(::SSL_CTX_get0_certificate(tls->native_handle()));
  }
  try {
    listen(at);
  } catch (const boost::system::system_error& error) {
    throw StartupError("--view: " + where.address + ":" + std::to_string(where.port) + ": " + error.code().message(),
                       "end what listens there, or give another port (--view alone takes a free one)");
  }
  await_newcomers();
  thread_ = std::thread([this] {
    be_in_background();
    tick();
    io->run();
  });
}

BeastServer::~BeastServer() {
  ends_ = true;
  thread_.join();
  for (const auto& client : clients_) client->close();
}

void BeastServer::listen(const Tcp::endpoint& at) {
  listener_.open(Tcp::v4());
  static_cast<void>(::fcntl(listener_.native_handle(), F_SETFD, FD_CLOEXEC));
  listener_.set_option(Tcp::acceptor::reuse_address(true));
  listener_.bind(at);
  listener_.listen(kBacklog);
  listener_.non_blocking(true);
  url_ = (tls ? "https://" : "http://") + at.address().to_string() + ":" +
         std::to_string(listener_.local_endpoint().port()) + "/" + (rules.token.empty() ? "" : "?token=" + rules.token);
}

void BeastServer::await_newcomers() {
  listener_.async_wait(Tcp::acceptor::wait_read, [this](Error error) {
    if (!error) accept_newcomers();
  });
}

/// Where there is no descriptor for one, the oldest that has not asked yet gives up its own by the next tick.
void BeastServer::accept_newcomers() {
  Error error;
  for (int k = 0; k < kAcceptedAtOnce && !error; ++k) {
    Tcp::socket socket(*io);
    listener_.accept(socket, error);
    if (error) break;
    static_cast<void>(::fcntl(socket.native_handle(), F_SETFD, FD_CLOEXEC));
    const auto& client = clients_.emplace_back(std::make_shared<ViewClient>(std::move(socket), *this));
    static_cast<void>(enter(*client, Stage::kAsks));
    client->start();
  }
  if (!error || error == asio::error::would_block || error == asio::error::connection_aborted) return await_newcomers();
  const auto oldest = std::find_if(clients_.begin(), clients_.end(),
                                   [](const auto& client) { return client->stage() == Stage::kAsks; });
  if (oldest != clients_.end()) (*oldest)->close();
  lacks_descriptor_ = true;
}

bool BeastServer::enter(ViewClient& newcomer, Stage stage) {
  std::vector<Placed> placed;
  std::vector<ViewClient*> clients;
  const auto now = Clock::now();
  for (const auto& client : clients_) {
    if (client->stage() != stage || client->is_local() != newcomer.is_local()) continue;
    placed.push_back(client->placed(now));
    clients.push_back(client.get());
  }
  if (placed.size() >= places(stage)) {
    const auto loser = gives_way(placed, stage, newcomer.placed(now).address);
    if (!loser) return false;
    clients[*loser]->close();
  }
  newcomer.set_stage(stage);
  return true;
}

void BeastServer::welcome(ViewClient& client) {
  for (const ViewMessage& kept : kept_)
    if (kept.text) client.offer(kept);
}

void BeastServer::repeat(ViewClient& client, std::size_t channel) {
  if (said_[channel].text) client.offer(said_[channel]);
}

void BeastServer::tick() {
  const auto now = Clock::now();
  if (ends_ && ended_ == Clock::time_point{}) ended_ = now;
  pass_on();
  for (const auto& client : clients_) client->tick(now);
  std::erase_if(clients_, [](const auto& client) { return client->stage() == Stage::kGone; });
  count_clients();
  if (std::exchange(lacks_descriptor_, false)) accept_newcomers();
  const bool all_sent = std::none_of(clients_.begin(), clients_.end(), [](const auto& c) { return c->has_unsent(); });
  if (ends_ && (all_sent || now - ended_ > kFarewell)) return io->stop();
  timer_.expires_after(kTick);
  timer_.async_wait([this](Error) { tick(); });
}

void BeastServer::pass_on() {
  for (const ViewMessage* m = ring_.front(); m != nullptr; m = ring_.front()) {
    if (m->kind == MessageKind::kHello) kept_[0] = *m;
    if (m->kind == MessageKind::kField) kept_[1] = *m;
    if (m->kind == MessageKind::kTopic) said_[m->channel] = *m;
    for (const auto& client : clients_) client->offer(*m);
    ring_.pop();
  }
}

void BeastServer::count_clients() {
  int looking = 0;
  bool pages = false;
  std::uint32_t channels = 0;
  for (const auto& client : clients_) {
    channels |= client->wanted();
    pages = pages || client->is_page();
    looking += client->is_page() || client->wanted() != 0 ? 1 : 0;
  }
  viewers_ = looking;
  has_pages_ = pages;
  wanted_ = channels;
}

void be_in_background() noexcept {
  sigset_t all;
  sigfillset(&all);
  ::pthread_sigmask(SIG_BLOCK, &all, nullptr);
  const sched_param ordinary{};
  static_cast<void>(::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &ordinary));
  static_cast<void>(::pthread_setname_np(::pthread_self(), "view"));
}

std::unique_ptr<ViewServer> ViewServer::serve(const ViewAddress& where, ViewDoor door) {
  return std::make_unique<BeastServer>(where, std::move(door));
}

}  // namespace jaywalk::view
