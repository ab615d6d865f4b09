#include "drivers/motor/odrive_base.h"

#include "hal/types/errors.h"

namespace jaywalk::odrive {

OdriveBase::OdriveBase(CanBus& bus, Clock& clock, const BaseSetup& setup)
    : MotorPair(bus, clock,
                {setup.silence_limit, setup.settling, std::chrono::seconds(1), setup.stop, setup.allow_unproved}),
      setup_(setup) {
  require_axes(setup.axes, {"ODrive node", 0, 62});
}

std::string OdriveBase::who(std::size_t index) const {
  return "ODrive node " + std::to_string(setup_.axes[index].node) + ": ";
}

std::string OdriveBase::inspect(std::size_t side) {
  await_motor(side);
  return who(side) + "heartbeat and encoder estimates; errors " + error_words(seen_[side].errors) +
         "; whether its watchdog lets go is seen at arming, which takes torque";
}

StartupError OdriveBase::absence(std::size_t index) const {
  if (axis(index).heard == kNever)
    return {who(index) + "no heartbeat", "see that the bus is up and the drive is powered"};
  return {who(index) + "no encoder estimates", "set can.encoder_msg_rate_ms = 10 in the ODrive"};
}

void OdriveBase::begin_proof(std::size_t index) noexcept {
  proofs_[index].begin(setup_.axes[index].node, {setup_.watchdog_least, setup_.watchdog_limit}, clock().now());
}

ProofResult OdriveBase::continue_proof(std::size_t index) noexcept {
  const Seen& seen = seen_[index];
  const AxisReport report{axis(index).heard, seen.expired,   seen.errors,
                          seen.state,        seen.procedure, axis(index).speed_radps};
  for (const CanFrame& frame : proofs_[index].step(clock().now(), report)) send(frame);
  return proofs_[index].result();
}

std::string OdriveBase::proof_line(std::size_t index) const { return who(index) + proofs_[index].line(); }

std::string OdriveBase::proof_remedy(std::size_t index) const { return proofs_[index].remedy(); }

void OdriveBase::take(const ReceivedFrame& received) noexcept {
  for (const CanAxis& axis_setup : setup_.axes)
    if (is_order(received.frame, axis_setup.node)) return note_foreign(received.frame);
  const auto message = decode(received.frame);
  if (!message) return;
  for (std::size_t k = 0; k < setup_.axes.size(); ++k) {
    if (message->node != setup_.axes[k].node) continue;
    if (const auto* heartbeat = std::get_if<Heartbeat>(&message->content)) {
      if (!seen_[k].heartbeats.take_at(received.stamp, setup_.heartbeat_least)) note_foreign(received.frame);
      take_heartbeat(k, *heartbeat, received.stamp);
    }
    if (const auto* estimates = std::get_if<EncoderEstimates>(&message->content))
      take_estimates(k, *estimates, received.stamp);
  }
}

void OdriveBase::take_heartbeat(std::size_t index, const Heartbeat& heartbeat, Time stamp) noexcept {
  Seen& seen = seen_[index];
  const bool expired = (heartbeat.active_errors & kWatchdogExpired) != 0;
  if (!expired) seen.expired = kNever;
  if (expired && seen.expired == kNever) seen.expired = stamp;
  seen.errors = heartbeat.active_errors;
  seen.state = heartbeat.axis_state;
  seen.procedure = heartbeat.procedure;
  note_heard(index, stamp);
  note_obeys(index, heartbeat.axis_state == kClosedLoop && heartbeat.active_errors == 0);
  const DriveFault fault{DriveFaultKind::kOdrive, setup_.axes[index].node, heartbeat.active_errors};
  if ((heartbeat.active_errors & kEstopRequested) != 0) report_fault(DriveTrouble::kEmergency, fault);
  if (heartbeat.active_errors != 0) report_fault(DriveTrouble::kDriveFault, fault);
}

void OdriveBase::take_estimates(std::size_t index, const EncoderEstimates& estimates, Time stamp) noexcept {
  Seen& seen = seen_[index];
  const double turns_per_rad = setup_.axes[index].per_rad;
  const double turned = static_cast<double>(estimates.position_turns) - static_cast<double>(seen.position_turns);
  seen.position_turns = estimates.position_turns;
  note_turned(index, stamp, turned / turns_per_rad);
  note_speed(index, stamp, static_cast<double>(estimates.velocity_turns_per_s) / turns_per_rad);
}

void OdriveBase::send_order(std::size_t index, MotorOrder order, double speed_radps) noexcept {
  const std::uint8_t node = setup_.axes[index].node;
  // It disarms, and its wheel rolls out: nothing of an ODrive brakes without obeying.
  if (order == MotorOrder::kNetworkStop) return send(emergency_stop(node));
  if (order == MotorOrder::kOff && seen_[index].state != kIdle) send(set_axis_state(node, AxisState::kIdle));
  if (order == MotorOrder::kHold && seen_[index].state != kClosedLoop) {
    send(set_velocity_mode(node, true));
    send(set_axis_state(node, AxisState::kClosedLoop));
  }
  send(set_velocity(node, static_cast<float>(speed_radps * setup_.axes[index].per_rad)));
}

void OdriveBase::send_reset(std::size_t index) noexcept {
  send(set_velocity_mode(setup_.axes[index].node, true));
  send(set_velocity(setup_.axes[index].node, 0.0F));
  send(clear_errors(setup_.axes[index].node));
}

}  // namespace jaywalk::odrive
