#pragma once
#include <optional>
#include <utility>

#include "drivers/panel/joystick_panel.h"
#include "firmware/robot/operator_desk.h"
#include "firmware/robot/robot_file.h"

namespace jaywalk {

/// What people have in their hands: the desk behind the control socket and, where the file has one, a joystick in front
/// of it.
class OperatorControls {
 public:
  /// `clock` outlives it.
  OperatorControls(const RobotFile& file, Clock& clock, OperatorDesk::RestartBus restart_bus)
      : desk_(clock, {file.setup.goal_tolerance_m, file.goal_heading_tolerance_rad}, std::move(restart_bus)) {
    if (file.panel) joystick_.emplace(desk_, clock, file.panel->joystick, file.panel->needs_dead_man);
  }
  OperatorControls(const OperatorControls&) = delete;
  OperatorControls& operator=(const OperatorControls&) = delete;

  [[nodiscard]] OperatorDesk& desk() noexcept { return desk_; }
  /// What the loop sees.
  [[nodiscard]] OperatorPanel& panel() noexcept {
    if (joystick_) return *joystick_;
    return desk_;
  }

 private:
  OperatorDesk desk_;
  std::optional<panel::JoystickPanel> joystick_;
};

}  // namespace jaywalk
