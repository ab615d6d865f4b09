#include "firmware/robot/operator_controls.h"

#include "hal/types/errors.h"

namespace jaywalk {

OperatorControls::OperatorControls(const RobotFile& file, WiredDrive& drive, Clock& clock,
                                   OperatorDesk::RestartBus restart_bus)
    : desk_(clock, {file.setup.goal_tolerance_m, file.goal_heading_tolerance_rad}, std::move(restart_bus), file.places,
            {file.setup.zones, file.setup.model.footprint.inscribed_radius_m()}),
      wiring_(file.panel) {
  if (wiring_) {
    watch_.emplace(clock, wiring_->joystick);
    joystick_.emplace(desk_, *watch_, wiring_->needs_dead_man, file.setup.steering != StickUse::kNone);
  }
  gate_.emplace(joystick_ ? static_cast<OperatorPanel&>(*joystick_) : desk_, desk_.permission(), drive);
}

void OperatorControls::start(int priority) {
  if (!watch_) return;
  watch_->step();
  refuse_unrenewed(watch_->latest(), *wiring_);
  watch_->start(priority);
}

void OperatorControls::step() noexcept {
  if (watch_) watch_->step();
}

void refuse_unrenewed(const panel::JoystickState& state, const PanelWiring& wiring) {
  if (!state.needs_renewal || !wiring.needs_dead_man) return;
  throw StartupError(wiring.joystick.path + ": is on Bluetooth, whose link may die with the dead man held",
                     "give [panel] dead_man_renew_s, 2 say, or use a cable");
}

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
