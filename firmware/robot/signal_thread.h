#pragma once
#include <signal.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <thread>

namespace jaywalk {

/// Takes the signals that end a run, in a thread of its own that writes nowhere and waits for nothing else: SIGINT,
/// SIGTERM and, unless the process was started to outlive its terminal (nohup), SIGHUP. SIGPIPE is ignored, and
/// so are a terminal's SIGTSTP, SIGTTIN and SIGTTOU: a reader that is gone and a run in the background stop no robot.
class SignalThread {
 public:
  /// What the thread calls, for as long as this lives: `signalled` at each signal, `round` some 20 times a second.
  /// Neither may wait. Without one, before the loop runs, a signal does what it does to any program.
  class Handler {
   public:
    Handler(SignalThread& thread, std::function<void()> signalled, std::function<void()> round);
    ~Handler();
    Handler(const Handler&) = delete;
    Handler& operator=(const Handler&) = delete;

   private:
    friend class SignalThread;
    SignalThread& thread_;
    std::function<void()> signalled_, round_;
  };

  /// From now on the signals wait, here and in threads to come: make it before any other thread. `priority`: of
  /// SCHED_FIFO; 0: an ordinary thread.
  explicit SignalThread(int priority);
  ~SignalThread();
  SignalThread(const SignalThread&) = delete;
  SignalThread& operator=(const SignalThread&) = delete;

 private:
  void live(int priority) noexcept;
  void take(int signal) noexcept;

  sigset_t signals_{};
  std::mutex handling_;  ///< held while a handler is called
  const Handler* handler_ = nullptr;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace jaywalk
