#pragma once
// What a machine has that a robot's devices may hang on, as `jaywalk setup` sees it.
#include <memory>
#include <string>
#include <vector>

#include "drivers/can/can_bus.h"
#include "hal/hal.h"

namespace jaywalk {

/// Start-up only. Thread: one.
class Surroundings {
 public:
  virtual ~Surroundings() = default;
  /// Names of CAN interfaces, up or down.
  [[nodiscard]] virtual std::vector<std::string> can_interfaces() = 0;
  /// All frames of the interface, and the sole right to command there while it is kept. Throws StartupError where it is
  /// down, or another program has it.
  [[nodiscard]] virtual std::unique_ptr<CanBus> open_bus(const std::string& interface) = 0;
  /// Serial lines by names that do not change.
  [[nodiscard]] virtual std::vector<std::string> serial_lines() = 0;
  /// Addresses at which a scanner may answer: those that makers set, and those this machine has spoken to.
  [[nodiscard]] virtual std::vector<std::string> hosts() = 0;
  /// Joysticks behind evdev, by names that do not change.
  [[nodiscard]] virtual std::vector<std::string> joysticks() = 0;
};

/// This machine: /sys, /dev and the kernel's table of neighbours. `clock` outlives it.
[[nodiscard]] std::unique_ptr<Surroundings> this_machine(Clock& clock);

}  // namespace jaywalk
