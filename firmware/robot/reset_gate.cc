#include "firmware/robot/reset_gate.h"

namespace jaywalk {

OperatorInput ResetGate::latest() noexcept {
  OperatorInput input = panel_.latest();
  const bool edge = input.reset && !reset_before_;
  reset_before_ = input.reset;
  if (edge && !turns_) {
    drive_.reset();
    waits_ = true;
  }
  input.reset = waits_ && (drive_.is_proved() || drive_.trouble() != DriveTrouble::kNone);
  if (input.reset) waits_ = false;
  return input;
}

}  // namespace jaywalk
