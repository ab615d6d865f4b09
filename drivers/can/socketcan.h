#pragma once
// CAN through the Linux kernel: sockets; an interface's state, the right to it, its restart.
#include <linux/can.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <span>
#include <string>
#include <vector>

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

/// State and settings of a network interface, from the kernel.
struct LinkFacts {
  bool exists = false;
  bool is_can = false;
  bool is_up = false;
  std::string kind;               ///< "can" is a controller; "vcan", "slcan" and others; empty: none said
  std::uint32_t bitrate = 0;      ///< bit/s; 0: none set, or one that has none
  std::optional<CanState> state;  ///< of a controller
};

/// Asks rtnetlink. Start-up only; needs no privilege.
[[nodiscard]] LinkFacts link_facts(const std::string& interface);

/// The names of this machine's CAN interfaces, sorted, up or down. Start-up only.
[[nodiscard]] std::vector<std::string> can_interfaces();

/// The sole right on this machine to command what is on a CAN interface (SAFETY 16). It ends with the process, however
/// that ends, and counts where the interface does: a socket of the interface's network namespace, with no file.
/// Programs that do not ask for it, and other machines on the same wires,
/// are not kept away; what they send is a fault (DriveTrouble::kForeignMaster).
class BusLock {
 public:
  /// Throws StartupError where another process, or another lock of this one, has it.
  explicit BusLock(const std::string& interface);

 private:
  wire::FileDescriptor socket_;
};

/// Sets a network interface down and up again: what brings a CAN controller back from bus-off where the driver knows no
/// restart. Needs CAP_NET_ADMIN; may wait for the hardware. Not for the loop.
/// Returns what went wrong; empty: it is up.
[[nodiscard]] std::string restart_link(const std::string& interface);

}  // namespace jaywalk
