#include "drivers/motor/odrive_base.h"

#include <cmath>
#include <cstdio>

#include "hal/types/errors.h"

namespace jaywalk::odrive {

namespace {

constexpr std::uint8_t kIdle = static_cast<std::uint8_t>(AxisState::kIdle);
constexpr std::uint8_t kClosedLoop = static_cast<std::uint8_t>(AxisState::kClosedLoop);
constexpr Duration kAnswerLimit = std::chrono::seconds(1);
constexpr double kStill_radps = 0.05;  ///< noise of an encoder at rest

std::string hex(std::uint32_t number) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%08Xh", static_cast<unsigned>(number));
  return text.data();
}

}  // namespace

OdriveBase::OdriveBase(CanBus& bus, Clock& clock, const BaseSetup& setup)
    : MotorPair(bus, clock, setup.silence_limit, setup.settling), setup_(setup) {
  for (std::size_t k = 0; k < setup.axes.size(); ++k) {
    const AxisSetup& axis = setup.axes[k];
    if (axis.node > 62 || !std::isfinite(axis.turns_per_rad) || axis.turns_per_rad == 0.0) {
      throw StartupError(who(k) + "cannot be set up so", "give it a node from 0 to 62 and its turns per radian");
    }
  }
  if (setup.axes[0].node == setup.axes[1].node) {
    throw StartupError("ODrive axes: both have node " + std::to_string(setup.axes[0].node),
                       "give each a node of its own");
  }
}

std::string OdriveBase::who(std::size_t index) const {
  return "ODrive node " + std::to_string(setup_.axes[index].node) + ": ";
}

std::vector<std::string> OdriveBase::arm() {
  std::vector<std::string> report;
  for (std::size_t k = 0; k < setup_.axes.size(); ++k) await_messages(k);
  for (std::size_t k = 0; k < setup_.axes.size(); ++k) {
    std::string line;
    const bool proved = prove_watchdog(k, line);
    send(set_axis_state(setup_.axes[k].node, AxisState::kIdle));
    send(clear_errors(setup_.axes[k].node));
    report.push_back(who(k) + line);
    if (!proved && !setup_.allow_unproved) {
      throw StartupError(report.back(),
                         "set enable_watchdog, watchdog_timeout = 0.06 and can.heartbeat_msg_rate_ms = 10 in the "
                         "ODrive, or allow_unproved at your own risk");
    }
  }
  if (trouble() != DriveTrouble::kNone) {
    throw StartupError("CAN: " + std::string(name(trouble())), "see that the bus is up and the drives are powered");
  }
  begin_watch();
  return report;
}

std::string OdriveBase::inspect(std::size_t side) {
  await_messages(side);
  return who(side) + "heartbeat and encoder estimates; errors " + hex(seen_[side].errors) +
         "; whether its watchdog lets go is seen at arming, which takes torque";
}

void OdriveBase::await_messages(std::size_t index) {
  const Time began = clock().now();
  const auto complete = [&] { return axis(index).heard > began && seen_[index].has_position; };
  while (!complete() && clock().now() - began < kAnswerLimit) pass_time();
  if (axis(index).heard <= began) {
    throw StartupError(who(index) + "no heartbeat", "see that the bus is up and the drive is powered");
  }
  if (!seen_[index].has_position) {
    throw StartupError(who(index) + "no encoder estimates", "set can.encoder_msg_rate_ms = 10 in the ODrive");
  }
}

/// Feeds the watchdog with speed zero until the axis is in `state` without errors.
bool OdriveBase::hold_until(std::size_t index, std::uint8_t state) {
  const Time began = clock().now();
  const Seen& seen = seen_[index];
  for (int ms = 0; clock().now() - began < kAnswerLimit; ++ms) {
    if (ms % 10 == 0) send(set_velocity(setup_.axes[index].node, 0.0F));
    pass_time();
    if (axis(index).heard > began && seen.state == state && seen.errors == 0) return true;
  }
  return false;
}

bool OdriveBase::prove_watchdog(std::size_t index, std::string& line) {
  const std::uint8_t node = setup_.axes[index].node;
  const Seen& seen = seen_[index];
  send(set_axis_state(node, AxisState::kIdle));
  send(set_velocity_mode(node, true));
  send(set_velocity(node, 0.0F));  // before the errors go: or the watchdog makes one of them again
  send(clear_errors(node));
  if (!hold_until(index, kIdle)) {
    line = "errors " + hex(seen.errors) + " that do not clear: NOT PROVED";
    return false;
  }
  if (std::fabs(axis(index).speed_radps) > kStill_radps) {
    line = "turns, which it must not for the proof: NOT PROVED";
    return false;
  }
  send(set_axis_state(node, AxisState::kClosedLoop));
  if (!hold_until(index, kClosedLoop)) {
    line = "does not go to closed loop, errors " + hex(seen.errors) + ": NOT PROVED";
    return false;
  }
  send(set_velocity(node, 0.0F));
  const Time last_command = clock().now();
  const auto expired = [&seen] { return (seen.errors & kWatchdogExpired) != 0; };
  while (!expired() && clock().now() - last_command < setup_.watchdog_limit) pass_time();
  const auto after = std::chrono::duration_cast<std::chrono::milliseconds>(clock().now() - last_command).count();
  line = "watchdog: " + std::string(expired() ? "expired" : "nothing said") + " " + std::to_string(after) +
         " ms after the last command";
  const bool holds_on = expired() && seen.state == kClosedLoop;
  const bool hasty = expired() && clock().now() - last_command < setup_.watchdog_least;
  if (holds_on) line += ", and holds on";
  if (hasty) line += ", too soon for two commands";
  const bool proved = expired() && !holds_on && !hasty;
  if (!proved) line += ": NOT PROVED";
  return proved;
}

void OdriveBase::take(const ReceivedFrame& received) noexcept {
  const auto message = decode(received.frame);
  if (!message) return;
  for (std::size_t k = 0; k < setup_.axes.size(); ++k) {
    if (message->node != setup_.axes[k].node) continue;
    if (const auto* heartbeat = std::get_if<Heartbeat>(&message->content)) {
      axis(k).heard = received.stamp;
      seen_[k].errors = heartbeat->active_errors;
      seen_[k].state = heartbeat->axis_state;
      axis(k).obeys = heartbeat->axis_state == kClosedLoop && heartbeat->active_errors == 0;
      if ((heartbeat->active_errors & kEstopRequested) != 0) report_fault(DriveTrouble::kEmergency);
      if (heartbeat->active_errors != 0) report_fault(DriveTrouble::kDriveFault);
    }
    if (const auto* estimates = std::get_if<EncoderEstimates>(&message->content)) take_estimates(k, *estimates);
  }
}

void OdriveBase::take_estimates(std::size_t index, const EncoderEstimates& estimates) noexcept {
  Seen& seen = seen_[index];
  MotorAxis& of = axis(index);
  const double turns_per_rad = setup_.axes[index].turns_per_rad;
  const double turned = static_cast<double>(estimates.position_turns) - static_cast<double>(seen.position_turns);
  if (seen.has_position) of.turned_rad += turned / turns_per_rad;
  seen.has_position = true;
  seen.position_turns = estimates.position_turns;
  of.speed_radps = static_cast<double>(estimates.velocity_turns_per_s) / turns_per_rad;
  of.fresh_position = of.fresh_speed = true;
}

void OdriveBase::send_order(std::size_t index, MotorOrder order, double speed_radps) noexcept {
  const std::uint8_t node = setup_.axes[index].node;
  if (order == MotorOrder::kOff && seen_[index].state != kIdle) send(set_axis_state(node, AxisState::kIdle));
  if (order == MotorOrder::kHold && seen_[index].state != kClosedLoop) {
    send(set_axis_state(node, AxisState::kClosedLoop));
  }
  send(set_velocity(node, static_cast<float>(speed_radps * setup_.axes[index].turns_per_rad)));
}

void OdriveBase::send_reset(std::size_t index) noexcept {
  send(set_velocity(setup_.axes[index].node, 0.0F));
  send(clear_errors(setup_.axes[index].node));
}

// Whether a frame is taken changes nothing: there is no third way, and it is said again as long as it has to be.
void Stopper::brake() noexcept {
  for (const std::uint8_t node : nodes_) static_cast<void>(bus_.send(set_velocity(node, 0.0F)));
}

}  // namespace jaywalk::odrive
