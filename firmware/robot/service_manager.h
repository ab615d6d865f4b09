#pragma once
// What systemd and a terminal are told, and the signals that come.
#include <signal.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "drivers/wire/file_descriptor.h"
#include "hal/types/time.h"

namespace jaywalk {

/// What systemd is told about a run: ready, alive, stopping (sd_notify(3): datagrams to $NOTIFY_SOCKET). Without
/// systemd it says nothing. Threads: any but the loop's; alive() one.
class ServiceManager {
 public:
  /// `socket`: $NOTIFY_SOCKET, a path or, after '@', a name in the abstract space; empty: none. `watchdog`: within
  /// which systemd wants to hear, $WATCHDOG_USEC; 0: it does not.
  ServiceManager(std::string socket, Duration watchdog) : socket_(std::move(socket)), watchdog_(watchdog) {}
  /// As the environment has it.
  [[nodiscard]] static ServiceManager from_environment();

  /// The drives are armed and the loop ticks.
  void ready() const { say("READY=1\nSTATUS=armed"); }
  void stopping() const { say("STOPPING=1"); }
  /// No loop ticks any more: writing the tables has the limit of a stop (TimeoutStopSec), not the watchdog's.
  void loop_has_ended() const { say("STOPPING=1\nWATCHDOG_USEC=0"); }
  /// Passes on, four times in the watchdog's time, that the loop has ticked since: a loop that hangs is not alive.
  void alive(std::uint64_t ticks, Time now);

 private:
  void say(std::string_view words) const;

  std::string socket_;
  Duration watchdog_;
  std::uint64_t ticks_said_ = 0;
  Time said_ = kNever;
};

/// While it lives, nothing in this process waits for standard error: what is written there goes into a pipe that never
/// blocks, and a thread of this class passes it on to the terminal, file or pipe that was there. Where that does not
/// take it (Ctrl-S, a reader that sleeps or is gone), lines beyond the pipe's 64 kB are lost and counted. Its end waits
/// half a second for what is still to be passed on. Start-up and end: one thread.
class StderrRelay {
 public:
  /// Where no pipe can be made standard error stays as it is, and may block.
  StderrRelay();
  ~StderrRelay();

 private:
  struct Ends {
    wire::FileDescriptor pipe, out;  ///< out: what standard error was
    std::atomic<bool> done{false};
  };
  static void pass_on(Ends& ends) noexcept;

  std::shared_ptr<Ends> ends_;  ///< shared with the thread, which may outlast this one in a write that never ends
  std::thread thread_;
};

/// A line of the program's for a person, on standard error. Where that takes none the line is lost, and the next that
/// is taken says how many were. Any thread but the loop's.
void remark(const std::string& text);

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

  /// Makes the signals wait, here and in threads to come: before any other. `priority`: of SCHED_FIFO; 0: ordinary.
  explicit SignalThread(int priority);
  ~SignalThread();

 private:
  void live(int priority) noexcept;

  sigset_t signals_{};
  std::mutex handling_;  ///< held while a handler is called
  const Handler* handler_ = nullptr;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace jaywalk
