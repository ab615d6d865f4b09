#pragma once
#include <utility>

#include "drivers/panel/joystick.h"
#include "hal/hal.h"

namespace jaywalk::panel {

/// A joystick in front of whatever else tells the robot what to do: it adds its stop and its reset, and lets the goal
/// through only while the dead man's button is held. A joystick that is gone is an emergency stop.
class JoystickPanel final : public OperatorPanel {
 public:
  /// `goals` and `clock` outlive it. Without `needs_dead_man` the goal always passes.
  JoystickPanel(OperatorPanel& goals, Clock& clock, JoystickSetup setup, bool needs_dead_man)
      : goals_(goals), clock_(clock), joystick_(std::move(setup)), needs_dead_man_(needs_dead_man) {}

  [[nodiscard]] OperatorInput latest() noexcept override;
  /// As of the last call of latest().
  [[nodiscard]] JoystickState joystick() const noexcept { return joystick_.state(); }

 private:
  OperatorPanel& goals_;
  Clock& clock_;
  Joystick joystick_;
  bool needs_dead_man_;
};

}  // namespace jaywalk::panel
