#pragma once
#include "drivers/wired_drive.h"
#include "hal/hal.h"

namespace jaywalk {

/// An operator panel in front of another whose reset reaches the loop only once the drives may turn again.
///
/// A person's reset edge, at rest, resets the drives. Where they were in trouble that begins their whole proof (SAFETY
/// 15), and the loop stays latched until both have passed it; where it fails the loop is told, and latches anew by
/// that. Thread: the loop's.
class ResetGate final : public OperatorPanel {
 public:
  /// Both outlive it.
  ResetGate(OperatorPanel& panel, WiredDrive& drive) noexcept : panel_(panel), drive_(drive) {}

  [[nodiscard]] OperatorInput latest() noexcept override;
  /// After each tick: whether a wheel is felt turning. There is no reset then.
  void note_turning(bool turns) noexcept { turns_ = turns; }

 private:
  OperatorPanel& panel_;
  WiredDrive& drive_;
  bool turns_ = false;
  bool reset_before_ = false;
  bool waits_ = false;  ///< a reset that the loop was not told of yet
};

}  // namespace jaywalk
