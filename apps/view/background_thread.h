#pragma once
#include <pthread.h>
#include <signal.h>

#include <thread>
#include <utility>

namespace jaywalk::view {

/// A thread of ordinary priority, whatever its maker has, that takes no signals: these are for the thread that drives.
template <class Body>
std::thread background_thread(const char* name, Body body) {
  sigset_t all, before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread made(std::move(body));
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  const sched_param ordinary{};
  static_cast<void>(::pthread_setschedparam(made.native_handle(), SCHED_OTHER, &ordinary));
  static_cast<void>(::pthread_setname_np(made.native_handle(), name));
  return made;
}

}  // namespace jaywalk::view
