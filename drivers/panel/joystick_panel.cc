#include "drivers/panel/joystick_panel.h"

namespace jaywalk::panel {

OperatorInput JoystickPanel::latest() noexcept {
  OperatorInput input = goals_.latest();
  joystick_.poll(clock_.now());
  const JoystickState state = joystick_.state();
  input.emergency_stop = input.emergency_stop || state.stop;
  input.reset = input.reset || state.reset;
  if (needs_dead_man_ && !state.dead_man) input.has_goal = false;
  return input;
}

}  // namespace jaywalk::panel
