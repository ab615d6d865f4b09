#pragma once
#include <algorithm>
#include <chrono>

#include "hal/types/time.h"

namespace jaywalk {

/// Puts the kernel's stamps of received frames, which are the wall clock's, on the control time line.
///
/// Only a frame's age is taken from the wall clock. It lies between nothing and the time since the socket was last
/// found empty, whatever the wall clock is set to; where the clock was set since then, an age says nothing, and the
/// greatest that can be counts. So feedback looks no fresher than it may be, and older by no more than the time between
/// two readings of the socket.
class ArrivalClock {
 public:
  explicit ArrivalClock(Time now) noexcept : empty_(now) {}

  /// The socket holds nothing at `now`: what comes later arrived later.
  void note_empty(Time now, Duration wall) noexcept {
    empty_ = now;
    offset_ = wall - now.time_since_epoch();
    knows_offset_ = true;
  }
  /// When a frame arrived that is stamped `stamp`, read at `now`; `wall` is the wall clock now. Both since its epoch.
  [[nodiscard]] Time arrival(Duration stamp, Duration wall, Time now) const noexcept {
    const Duration longest = std::max<Duration>(now - empty_, Duration{0});
    const Duration stepped = knows_offset_ ? wall - now.time_since_epoch() - offset_ : Duration{0};
    if (stepped > kStep || stepped < -kStep) return now - longest;
    return now - std::clamp<Duration>(wall - stamp, Duration{0}, longest);
  }

 private:
  /// A clock that is slewed (adjtime(3): 0.5 ms a second) moves less than that between two readings.
  static constexpr Duration kStep = std::chrono::milliseconds(2);

  Time empty_;
  Duration offset_{0};  ///< of the wall clock from the control time line, when the socket was last empty
  bool knows_offset_ = false;
};

}  // namespace jaywalk
