#include "drivers/panel/device_keys.h"

#include <linux/input.h>
#include <linux/joystick.h>
#include <sys/ioctl.h>

namespace jaywalk::panel {
namespace {

/// <linux/input.h>'s EVIOCGBIT: 20h and the type of event.
constexpr unsigned long which_codes(unsigned type, std::size_t bytes) noexcept {
  return _IOC(_IOC_READ, 0x45U, 0x20U + type, static_cast<unsigned>(bytes));  // 45h: 'E'
}
/// <linux/joystick.h>'s JSIOCGBUTTONS, without its mixed signs.
constexpr unsigned long kHowManyButtons = _IOC(_IOC_READ, 0x6AU, 0x12U, 1U);  // 6Ah: 'j'

template <std::size_t N>
bool has(const std::array<std::uint8_t, N>& bits, std::uint16_t code) noexcept {
  return code / 8U < N && (static_cast<unsigned>(bits[code / 8U]) >> (code % 8U) & 1U) != 0;
}

bool has_stick(const DeviceKeys& keys, const JoystickSetup& setup) noexcept {
  return has(keys.axes, setup.forward) && has(keys.axes, setup.left);
}

}  // namespace

DeviceKeys keys_of(int device) noexcept {
  DeviceKeys keys;
  std::uint8_t buttons = 0;
  keys.old_joystick = ::ioctl(device, kHowManyButtons, &buttons) >= 0;
  keys.answers = ::ioctl(device, which_codes(EV_KEY, keys.buttons.size()), keys.buttons.data()) >= 0;
  static_cast<void>(::ioctl(device, which_codes(EV_ABS, keys.axes.size()), keys.axes.data()));
  return keys;
}

bool has_all(const DeviceKeys& keys, const JoystickSetup& setup) noexcept {
  const bool stops = keys.answers && has(keys.buttons, setup.stop);
  return stops && (!setup.needs_dead_man || has(keys.buttons, setup.dead_man)) &&
         (!setup.steers || has_stick(keys, setup));
}

std::string lacking(const DeviceKeys& keys, const JoystickSetup& setup) {
  if (has_all(keys, setup)) return "";
  if (keys.old_joystick) return "speaks the older joystick interface, whose buttons have no numbers of their own";
  if (!keys.answers) return "is no input device: it does not tell which buttons it has";
  const auto button = [](const char* key, std::uint16_t code) {
    return "has no button " + std::to_string(code) + ", which [panel] " + key + " names";
  };
  if (!has(keys.buttons, setup.stop)) return button("stop_button", setup.stop);
  if (setup.needs_dead_man && !has(keys.buttons, setup.dead_man)) return button("dead_man_button", setup.dead_man);
  return "has no stick, which [panel] steering needs";
}

}  // namespace jaywalk::panel
