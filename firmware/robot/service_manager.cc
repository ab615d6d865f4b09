#include "firmware/robot/service_manager.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "drivers/wire/thread_without_signals.h"
#include "firmware/robot/realtime.h"

namespace jaywalk {
namespace {

std::string text_of(const char* variable) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? "" : text;
}

constexpr std::chrono::milliseconds kPatience{500}, kPause{10};

std::atomic<std::uint64_t> lines_lost{0};

constexpr timespec kSignalRound{.tv_sec = 0, .tv_nsec = 50'000'000};

bool is_ignored(int signal) noexcept {
  struct sigaction now {};
  return ::sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

}  // namespace

ServiceManager ServiceManager::from_environment() {
  const std::int64_t watchdog_us = std::strtoll(text_of("WATCHDOG_USEC").c_str(), nullptr, 10);
  return {text_of("NOTIFY_SOCKET"), std::chrono::microseconds(std::max<std::int64_t>(watchdog_us, 0))};
}

void ServiceManager::alive(std::uint64_t ticks, Time now) {
  const bool due = said_ == kNever || now - said_ >= watchdog_ / 4;
  if (watchdog_ <= Duration{0} || ticks == ticks_said_ || !due) return;
  ticks_said_ = ticks;
  said_ = now;
  say("WATCHDOG=1");
}

void ServiceManager::say(std::string_view words) const {
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  if (socket_.empty() || socket_.size() >= sizeof to.sun_path) return;
  std::memcpy(to.sun_path, socket_.data(), socket_.size());
  if (to.sun_path[0] == '@') to.sun_path[0] = '\0';
  const wire::FileDescriptor sender(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + socket_.size());
  // A lost datagram is a beat that is missed: the next one comes in a quarter of the watchdog's time.
  static_cast<void>(::sendto(sender.get(), words.data(), words.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                             reinterpret_cast<const sockaddr*>(&to), length));
}

StderrRelay::StderrRelay() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return;
  wire::FileDescriptor entry(ends[1]);
  ends_ = std::make_shared<Ends>();
  ends_->pipe = wire::FileDescriptor(ends[0]);
  ends_->out = wire::FileDescriptor(::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
  ::fcntl(entry.get(), F_SETFL, O_NONBLOCK);  // of this end alone
  ::dup2(entry.get(), STDERR_FILENO);
  thread_ = thread_without_signals("said", [ends = ends_] { pass_on(*ends); });
}

StderrRelay::~StderrRelay() {
  if (!ends_) return;
  ::dup2(ends_->out.get(), STDERR_FILENO);  // the pipe's last writer is gone: its reader comes to the end
  for (auto waited = kPause; !ends_->done && waited < kPatience; waited += kPause) std::this_thread::sleep_for(kPause);
  if (ends_->done)
    thread_.join();
  else
    thread_.detach();
}

void StderrRelay::pass_on(Ends& ends) noexcept {
  std::array<char, 4096> part{};
  for (ssize_t got = 0; (got = ::read(ends.pipe.get(), part.data(), part.size())) > 0;) {
    const char* next = part.data();
    while (got > 0) {
      const ssize_t taken = ::write(ends.out.get(), next, static_cast<std::size_t>(got));
      if (taken < 0 && errno == EAGAIN) {  // another end of the same terminal was set not to block
        pollfd ready{.fd = ends.out.get(), .events = POLLOUT, .revents = 0};
        ::poll(&ready, 1, -1);
      } else if (taken < 0 && errno != EINTR) {
        break;  // its reader is gone: the rest goes nowhere
      } else if (taken > 0) {
        next += taken, got -= taken;
      }
    }
  }
  ends.done = true;
}

void remark(const std::string& text) {
  const std::uint64_t lost = lines_lost.exchange(0);
  const std::string before = lost > 0 ? "(" + std::to_string(lost) + " lines were lost) " : "";
  if (std::fprintf(stderr, "jaywalk: %s%s\n", before.c_str(), text.c_str()) < 0) lines_lost += lost + 1;
}

SignalThread::SignalThread(int priority) {
  for (const int signal : {SIGPIPE, SIGTSTP, SIGTTIN, SIGTTOU}) ::signal(signal, SIG_IGN);
  sigemptyset(&signals_);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (signal != SIGHUP || !is_ignored(SIGHUP)) sigaddset(&signals_, signal);
  ::pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  thread_ = thread_without_signals("signals", [this, priority] { live(priority); });
}

SignalThread::~SignalThread() {
  ending_ = true;
  thread_.join();  // the signals go on waiting: the end of a run is not broken off
}

void SignalThread::live(int priority) noexcept {
  static_cast<void>(enter_realtime({.priority = priority}));  // the loop's thread tells what is not permitted
  while (!ending_) {
    const int signal = ::sigtimedwait(&signals_, nullptr, &kSignalRound);
    const std::lock_guard lock(handling_);
    if (handler_ != nullptr) {
      if (signal > 0) handler_->signalled_();
      handler_->round_();
    } else if (signal > 0) {
      ::signal(signal, SIG_DFL);
      ::pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
      ::raise(signal);
    }
  }
}

SignalThread::Handler::Handler(SignalThread& thread, std::function<void()> signalled, std::function<void()> round)
    : thread_(thread), signalled_(std::move(signalled)), round_(std::move(round)) {
  const std::lock_guard lock(thread.handling_);
  thread.handler_ = this;
}

SignalThread::Handler::~Handler() {
  const std::lock_guard lock(thread_.handling_);
  thread_.handler_ = nullptr;
}

}  // namespace jaywalk
