#include "drivers/panel/joystick_panel.h"

namespace jaywalk::panel {

OperatorInput JoystickPanel::latest() noexcept {
  OperatorInput input = goals_.latest();
  const std::uint32_t stops_before = state_.stops;
  state_ = joystick_.latest();
  const bool stopped_meanwhile = state_.stops != stops_before;
  input.emergency_stop = input.emergency_stop || state_.stop || stopped_meanwhile;
  input.reset = input.reset || state_.reset;
  if (needs_dead_man_ && !state_.dead_man) input.has_goal = false;
  if (!stick_drives_) return input;
  input.stick = {state_.forward, state_.left};
  input.steers = !input.stick.is_centred() || !input.has_goal;
  if (input.steers) input.has_goal = false;
  return input;
}

}  // namespace jaywalk::panel
