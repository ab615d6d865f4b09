#pragma once
#include <optional>

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
  OperatorControls(const RobotFile& file, WiredDrive& drive, Clock& clock, OperatorDesk::RestartBus restart_bus);
  OperatorControls(const OperatorControls&) = delete;
  OperatorControls& operator=(const OperatorControls&) = delete;

  /// Start-up only: looks at the joystick once and starts its thread, with a priority of SCHED_FIFO (0: an ordinary
  /// one). Throws StartupError where its dead man could stay held when its link has died.
  void start(int priority);
  /// What the thread does: by hand where none was started.
  void step() noexcept;

  [[nodiscard]] OperatorDesk& desk() noexcept { return desk_; }
  /// What the loop sees.
  [[nodiscard]] OperatorPanel& panel() noexcept { return *gate_; }
  [[nodiscard]] ResetGate& resets() noexcept { return *gate_; }

 private:
  OperatorDesk desk_;
  std::optional<PanelWiring> wiring_;
  std::optional<panel::JoystickWatch> watch_;
  std::optional<panel::JoystickPanel> joystick_;
  std::optional<ResetGate> gate_;
};

/// Throws StartupError for a dead man that could stay held when its link has died.
void refuse_unrenewed(const panel::JoystickState& state, const PanelWiring& wiring);

}  // namespace jaywalk
