#include "firmware/robot/signal_thread.h"

#include <pthread.h>
#include <time.h>

#include "drivers/wire/thread_without_signals.h"
#include "firmware/robot/realtime.h"

namespace jaywalk {
namespace {

constexpr timespec kSignalRound{.tv_sec = 0, .tv_nsec = 50'000'000};

bool is_ignored(int signal) noexcept {
  struct sigaction now {};
  return ::sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

}  // namespace

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
    if (signal > 0) take(signal);
    if (handler_ != nullptr) handler_->round_();
  }
}

void SignalThread::take(int signal) noexcept {
  if (handler_ != nullptr) return handler_->signalled_();
  ::signal(signal, SIG_DFL);
  ::pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
  ::raise(signal);
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
