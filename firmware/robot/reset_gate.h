#pragma once
#include "drivers/wired_drive.h"
#include "firmware/robot/permission.h"
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

}  // namespace jaywalk
