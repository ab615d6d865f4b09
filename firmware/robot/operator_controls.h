#pragma once
#include <optional>
#include <utility>

#include "drivers/panel/joystick_panel.h"
#include "firmware/robot/operator_desk.h"
#include "firmware/robot/reset_gate.h"
#include "firmware/robot/robot_file.h"

namespace jaywalk {

/// What people have in their hands: the desk behind the control socket and, where the file has one, a joystick in front
/// of it. Their resets wait until the drives are proved.
class OperatorControls {
 public:
  /// `drive` and `clock` outlive it.
  OperatorControls(const RobotFile& file, WiredDrive& drive, Clock& clock, OperatorDesk::RestartBus restart_bus)
      : desk_(clock, {file.setup.goal_tolerance_m, file.goal_heading_tolerance_rad}, std::move(restart_bus)) {
    if (file.panel) joystick_.emplace(desk_, clock, file.panel->joystick, file.panel->needs_dead_man);
    gate_.emplace(joystick_ ? static_cast<OperatorPanel&>(*joystick_) : desk_, drive);
  }
  OperatorControls(const OperatorControls&) = delete;
  OperatorControls& operator=(const OperatorControls&) = delete;

  [[nodiscard]] OperatorDesk& desk() noexcept { return desk_; }
  /// What the loop sees.
  [[nodiscard]] OperatorPanel& panel() noexcept { return *gate_; }
  [[nodiscard]] ResetGate& resets() noexcept { return *gate_; }

 private:
  OperatorDesk desk_;
  std::optional<panel::JoystickPanel> joystick_;
  std::optional<ResetGate> gate_;
};

}  // namespace jaywalk
