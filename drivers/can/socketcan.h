#pragma once
// CAN through the Linux kernel.
#include <linux/can.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <span>
#include <string>

#include "drivers/can/can_bus.h"
#include "drivers/wire/file_descriptor.h"
#include "hal/hal.h"
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
  }
  /// When a frame arrived that is stamped `stamp`, read at `now`; `wall` is the wall clock now. Both since its epoch.
  [[nodiscard]] Time arrival(Duration stamp, Duration wall, Time now) const noexcept {
    const Duration longest = std::max<Duration>(now - empty_, Duration{0});
    const Duration stepped = offset_ ? wall - now.time_since_epoch() - *offset_ : Duration{0};
    if (stepped > kStep || stepped < -kStep) return now - longest;
    return now - std::clamp<Duration>(wall - stamp, Duration{0}, longest);
  }

 private:
  /// A clock that is slewed (adjtime(3): 0.5 ms a second) moves less than that between two readings.
  static constexpr Duration kStep = std::chrono::milliseconds(2);

  Time empty_;
  std::optional<Duration> offset_;  ///< of the wall clock from the control time line, when the socket was last empty
};

/// Lets through the data frames (or, where `remote`, the requests for them) whose identifier agrees with `id` where
/// `mask` has ones.
struct CanFilter {
  std::uint32_t id = 0;
  std::uint32_t mask = 0;
  bool extended = false;
  bool remote = false;
};

/// `frame` is valid.
[[nodiscard]] can_frame to_kernel(const CanFrame& frame) noexcept;
[[nodiscard]] can_filter to_kernel(const CanFilter& filter) noexcept;

/// Nothing for an error frame and for what is_valid refuses.
[[nodiscard]] std::optional<CanFrame> from_kernel(const can_frame& frame) noexcept;

[[nodiscard]] inline bool is_error(const can_frame& frame) noexcept { return (frame.can_id & CAN_ERR_FLAG) != 0; }

/// The controller's state after the error frame `error`, given the one before. A protocol error alone leaves it.
[[nodiscard]] CanState state_after(const can_frame& error, CanState before) noexcept;

/// A raw CAN socket, bound, non-blocking, with filters in the kernel, error frames on and kernel time stamps.
/// Without any filter nothing comes in but errors. Throws StartupError "can0: cause; remedy": no such interface, a
/// kernel without CAN, no CAN interface.
[[nodiscard]] wire::FileDescriptor open_can(const std::string& interface, std::span<const CanFilter> filters);

/// A place on a real bus (or vcan, slcan) through the Linux kernel.
///
/// Error frames change health() and are not handed out. Bus-off is reported and stays: recovery is for a person's
/// reset, and then for permission to set the link down and up.
class SocketCan final : public CanBus {
 public:
  /// `socket` is open_can's; the clock, which outlives this, counts the control time line.
  SocketCan(wire::FileDescriptor socket, Clock& clock) noexcept;

  /// The same kernel socket once more, for a second thread that only sends: to the kernel, and so to this, its frames
  /// are own ones and do not come back. Start-up only; throws StartupError.
  [[nodiscard]] wire::FileDescriptor second() const;

  /// Start-up only: hands out what passes these from now on. Throws StartupError.
  void listen(std::span<const CanFilter> filters);

  [[nodiscard]] bool send(const CanFrame& frame) noexcept override;
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override;
  [[nodiscard]] CanHealth health() const noexcept override { return health_; }

 private:
  void note_error(const can_frame& error) noexcept;

  wire::FileDescriptor socket_;
  Clock& clock_;
  ArrivalClock arrivals_;
  CanHealth health_;
};

}  // namespace jaywalk
