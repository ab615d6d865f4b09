#pragma once
#include <signal.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
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

/// Hands every T from one writing thread to one reading thread, in order; neither ever waits. Memory is taken in the
/// constructor. A full ring takes no more, and the writer is told.
template <class T, std::size_t N>
class Ring {
 public:
  /// Writer's thread: the slot to fill; null when full.
  [[nodiscard]] T* draft() noexcept {
    const std::size_t next = written_.load(std::memory_order_relaxed);
    if (next - read_.load(std::memory_order_acquire) == N) return nullptr;
    return &(*slots_)[next % N];
  }
  /// Writer's thread: the draft is complete.
  void publish() noexcept { written_.fetch_add(1, std::memory_order_release); }
  /// Reader's thread: the oldest; null when there is none. Valid until pop().
  [[nodiscard]] const T* front() const noexcept {
    const std::size_t next = read_.load(std::memory_order_relaxed);
    if (next == written_.load(std::memory_order_acquire)) return nullptr;
    return &(*slots_)[next % N];
  }
  void pop() noexcept { read_.fetch_add(1, std::memory_order_release); }

 private:
  std::unique_ptr<std::array<T, N>> slots_ = std::make_unique<std::array<T, N>>();
  std::atomic<std::size_t> written_{0};
  std::atomic<std::size_t> read_{0};
};

}  // namespace jaywalk
