#pragma once
#include <optional>

#include "drivers/panel/joystick_panel.h"
#include "firmware/robot/operator_desk.h"
#include "firmware/robot/robot_file.h"

namespace jaywalk {

/// What people have in their hands: the desk behind the control socket and, where the file has one, a joystick in front
/// of it.
class OperatorControls {
 public:
  /// `clock` outlives it.
  OperatorControls(const RobotFile& file, Clock& clock, OperatorDesk::RestartBus restart_bus);
  OperatorControls(const OperatorControls&) = delete;
  OperatorControls& operator=(const OperatorControls&) = delete;

  /// Start-up only: looks at the joystick once and starts its thread, with a priority of SCHED_FIFO (0: an ordinary
  /// one). Throws StartupError where its dead man could stay held when its link has died.
  void start(int priority);
  /// What the thread does: by hand where none was started.
  void step() noexcept;

  [[nodiscard]] OperatorDesk& desk() noexcept { return desk_; }
  /// What the loop sees.
  [[nodiscard]] OperatorPanel& panel() noexcept;

 private:
  OperatorDesk desk_;
  std::optional<PanelWiring> wiring_;
  std::optional<panel::JoystickWatch> watch_;
  std::optional<panel::JoystickPanel> joystick_;
};

/// Throws StartupError for a dead man that could stay held when its link has died.
void refuse_unrenewed(const panel::JoystickState& state, const PanelWiring& wiring);

}  // namespace jaywalk
