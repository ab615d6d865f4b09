#include "firmware/robot/reset_gate.h"

namespace jaywalk {

OperatorInput ResetGate::latest() noexcept {
  OperatorInput input = panel_.latest();
  input.stick = permission_.admitted(input.stick);
  const bool edge = input.reset && !reset_before_;
  reset_before_ = input.reset;
  if (input.emergency_stop) {
    permission_.revoke();
  } else if (edge && !turns_) {
    drive_.reset();
    permission_.let_reset_wait();
  }
  input.reset = permission_.reset_waits() && drive_.is_proved();
  if (input.reset) permission_.reset_is_done();
  return input;
}

}  // namespace jaywalk
