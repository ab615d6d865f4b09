#include "drivers/wire/thread_without_signals.h"

#include <pthread.h>
#include <signal.h>

namespace jaywalk {

std::thread thread_without_signals(const char* name, std::function<void()> lives) {
  sigset_t all, before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread thread(std::move(lives));
  ::pthread_setname_np(thread.native_handle(), name);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

}  // namespace jaywalk
