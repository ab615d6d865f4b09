#pragma once
#include <optional>

#include "drivers/panel/joystick_watch.h"
#include "drivers/wired_drive.h"
#include "firmware/robot/operator_desk.h"
#include "firmware/robot/place_check.h"
#include "firmware/robot/robot_file.h"
#include "hal/hal.h"

namespace jaywalk {

/// An operator panel in front of another: its reset reaches the loop only once the drives may turn again, and its stick
/// as far as it is permitted (Permission::admitted()).
///
/// A person's reset edge, at rest, resets the drives. Where they were in trouble that begins their whole proof (SAFETY
/// 15), and the loop stays latched until both have passed it. A stop, a fault and another order meanwhile void the
/// reset (Permission). Thread: the loop's.
class ResetGate final : public OperatorPanel {
 public:
  /// All outlive it.
  ResetGate(OperatorPanel& panel, Permission& permission, WiredDrive& drive) noexcept
      : panel_(panel), permission_(permission), drive_(drive) {}

  [[nodiscard]] OperatorInput latest() noexcept override;
  /// After each tick: whether a wheel is felt turning. There is no reset then.
  void note_turning(bool turns) noexcept { turns_ = turns; }

 private:
  OperatorPanel& panel_;
  Permission& permission_;
  WiredDrive& drive_;
  bool turns_ = false;
  bool reset_before_ = false;
};

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
