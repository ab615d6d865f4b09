#pragma once
#include <span>
#include <string>

#include "drivers/can/arrival_clock.h"
#include "drivers/can/can_bus.h"
#include "drivers/can/kernel_frame.h"
#include "drivers/wire/file_descriptor.h"
#include "hal/hal.h"

namespace jaywalk {

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

  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override;
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
