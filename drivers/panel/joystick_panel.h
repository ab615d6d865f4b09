#pragma once
#include "drivers/panel/joystick_watch.h"
#include "hal/hal.h"

namespace jaywalk::panel {

/// A joystick in front of whatever else tells the robot what to do: it adds its stop and its reset, and lets the goal
/// through only while the dead man's button is held. A joystick that is gone is an emergency stop. Where the stick
/// drives, it does so when it leaves its middle, goal or no goal, and goes on while there is none.
class JoystickPanel final : public OperatorPanel {
 public:
  /// Both outlive it. Without `needs_dead_man` the goal always passes, and no stick drives.
  JoystickPanel(OperatorPanel& goals, JoystickWatch& joystick, bool needs_dead_man, bool stick_drives = false) noexcept
      : goals_(goals), joystick_(joystick), needs_dead_man_(needs_dead_man), stick_drives_(stick_drives) {}

  [[nodiscard]] OperatorInput latest() noexcept override;
  /// As of the last call of latest().
  [[nodiscard]] const JoystickState& joystick() const noexcept { return state_; }

 private:
  OperatorPanel& goals_;
  JoystickWatch& joystick_;
  JoystickState state_;
  bool needs_dead_man_, stick_drives_;
};

}  // namespace jaywalk::panel
