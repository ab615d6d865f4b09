#pragma once
#include <cstdint>
#include <string>
#include <string_view>

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
  /// The drives are disarmed and no loop ticks any more: writing tables and picture may take longer than the watchdog
  /// waits, and has the limit of a stop (TimeoutStopSec).
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

}  // namespace jaywalk
