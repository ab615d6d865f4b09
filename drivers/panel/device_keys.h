#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "drivers/panel/joystick.h"

namespace jaywalk::panel {

/// What an input device says that it has (EVIOCGBIT), a bit for each number of <linux/input-event-codes.h>.
struct DeviceKeys {
  bool answers = false;       ///< it is an evdev device
  bool old_joystick = false;  ///< it is one of the older interface, /dev/input/js0 say
  std::array<std::uint8_t, 96> buttons{};
  std::array<std::uint8_t, 8> axes{};
};

/// Asks an open device.
[[nodiscard]] DeviceKeys keys_of(int device) noexcept;

/// Which of the buttons and axes that a setup needs the device lacks, in words; empty where it has them all.
[[nodiscard]] std::string lacking(const DeviceKeys& keys, const JoystickSetup& setup);
/// The same as a matter of fact; takes no memory.
[[nodiscard]] bool has_all(const DeviceKeys& keys, const JoystickSetup& setup) noexcept;

}  // namespace jaywalk::panel
