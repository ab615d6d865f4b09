#pragma once
#include <pthread.h>
#include <signal.h>

#include <functional>
#include <thread>
#include <utility>

namespace jaywalk {

/// A thread to which no signal of the process goes: they are for the thread that knows what to do with them. `name`:
/// what ps shows, at most 15 characters.
[[nodiscard]] inline std::thread thread_without_signals(const char* name, std::function<void()> lives) {
  sigset_t all, before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread thread(std::move(lives));
  ::pthread_setname_np(thread.native_handle(), name);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

}  // namespace jaywalk
