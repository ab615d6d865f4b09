#include "drivers/motor/vesc_base.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "hal/types/errors.h"

namespace jaywalk::vesc {

namespace {

constexpr Duration kAnswerLimit = std::chrono::milliseconds(500);

std::int32_t to_erpm(double speed_radps, double electrical_turns_per_rad) noexcept {
  constexpr double kMost = 1e6;  // more than any motor has
  const double erpm = std::clamp(speed_radps * electrical_turns_per_rad * 60.0, -kMost, kMost);
  return static_cast<std::int32_t>(erpm < 0.0 ? erpm - 0.5 : erpm + 0.5);
}

}  // namespace

VescBase::VescBase(CanBus& bus, Clock& clock, const BaseSetup& setup)
    : MotorPair(bus, clock, setup.silence_limit, setup.settling), setup_(setup) {
  for (std::size_t k = 0; k < setup.axes.size(); ++k) {
    const AxisSetup& axis = setup.axes[k];
    const double turns = axis.electrical_turns_per_rad;
    if (axis.controller > 253 || axis.controller == setup.own || !std::isfinite(turns) || turns == 0.0) {
      throw StartupError(who(k) + "cannot be set up so",
                         "give it a number from 0 to 253 other than ours, and its electrical turns per radian");
    }
  }
  if (setup.axes[0].controller == setup.axes[1].controller) {
    throw StartupError("VESCs: both have number " + std::to_string(setup.axes[0].controller),
                       "give each a number of its own");
  }
}

std::string VescBase::who(std::size_t index) const {
  return "VESC " + std::to_string(setup_.axes[index].controller) + ": ";
}

std::vector<std::string> VescBase::arm() {
  std::vector<std::string> report;
  for (std::size_t k = 0; k < setup_.axes.size(); ++k) await_messages(k);
  for (std::size_t k = 0; k < setup_.axes.size(); ++k) report.push_back(proof_of(k));
  if (trouble() != DriveTrouble::kNone) {
    throw StartupError("CAN: " + std::string(name(trouble())), "see that the bus is up and the drives are powered");
  }
  begin_watch();
  return report;
}

std::string VescBase::inspect(std::size_t side) {
  await_messages(side);
  return proof_of(side);
}

std::string VescBase::proof_of(std::size_t index) {
  std::string line;
  const bool proved = prove_timeout(index, line);
  line = who(index) + line;
  if (proved || setup_.allow_unproved) return line;
  throw StartupError(line,
                     "set timeout and timeout brake current (App Settings, General) with VESC Tool, or "
                     "allow_unproved at your own risk");
}

void VescBase::await_messages(std::size_t index) {
  const Time began = clock().now();
  const auto complete = [&] { return axis(index).heard > began && seen_[index].has_travel; };
  while (!complete() && clock().now() - began < kAnswerLimit) pass_time();
  if (complete()) return;
  throw StartupError(who(index) + (axis(index).heard > began ? "no status message 5" : "no status message 1"),
                     "see that it has power, and switch on status messages 1 and 5 at 50 Hz or more with VESC Tool");
}

bool VescBase::prove_timeout(std::size_t index, std::string& line) {
  Seen& seen = seen_[index];
  reader_.begin();
  seen.answered = false;
  send(ask_settings(setup_.axes[index].controller, setup_.own));
  for (const Time began = clock().now(); !seen.answered && clock().now() - began < kAnswerLimit;) pass_time();
  if (!seen.settings) {
    line = std::string("timeout: ") + (seen.answered ? "answer damaged" : "no answer") + ": NOT PROVED";
    return false;
  }
  const auto in_ms = [](Duration d) {
    return static_cast<int>(std::chrono::duration_cast<std::chrono::milliseconds>(d).count());
  };
  const auto timeout = std::chrono::milliseconds(seen.settings->timeout_ms);
  const bool proved =
      timeout >= setup_.timeout_least && timeout <= setup_.timeout_most && seen.settings->brake_current_a > 0.0;
  std::array<char, 120> text{};
  std::snprintf(text.data(), text.size(), "timeout: wanted %d to %d ms, reads %u ms, then brakes with %.1f A%s",
                in_ms(setup_.timeout_least), in_ms(setup_.timeout_most),
                static_cast<unsigned>(seen.settings->timeout_ms), seen.settings->brake_current_a,
                proved ? "" : ": NOT PROVED");
  line = text.data();
  return proved;
}

void VescBase::take(const ReceivedFrame& received) noexcept {
  const auto message = decode(received.frame);
  if (!message) return;
  if (message->controller == setup_.own) return take_answer(*message);
  for (std::size_t k = 0; k < setup_.axes.size(); ++k) {
    if (message->controller == setup_.axes[k].controller) take_own(k, *message, received.stamp);
  }
}

void VescBase::take_own(std::size_t index, const Message& message, Time stamp) noexcept {
  Seen& seen = seen_[index];
  MotorAxis& of = axis(index);
  const double turns = setup_.axes[index].electrical_turns_per_rad;
  if (const auto* status = std::get_if<Status>(&message.content)) {
    of.heard = stamp;
    of.speed_radps = status->erpm / (60.0 * turns);
    of.fresh_speed = true;
    of.obeys = seen.torque_on && seen.fault == 0;
  }
  if (const auto* travel = std::get_if<Travel>(&message.content)) {
    const auto raw = static_cast<std::uint32_t>(travel->sixths_of_electrical_turn);
    if (seen.has_travel) seen.sixths += counted(seen.travel, raw);
    seen.travel = raw;
    seen.has_travel = true;
    of.turned_rad = static_cast<double>(seen.sixths) / (6.0 * turns);
    of.fresh_position = true;
  }
}

void VescBase::take_answer(const Message& message) noexcept {
  if (const auto* piece = std::get_if<Piece>(&message.content)) reader_.take(*piece);
  const auto* end = std::get_if<PiecesEnd>(&message.content);
  const auto* fault = std::get_if<Fault>(&message.content);
  for (std::size_t k = 0; k < setup_.axes.size(); ++k) {
    const std::uint8_t controller = setup_.axes[k].controller;
    if (end != nullptr && end->from == controller) {
      seen_[k].settings = reader_.finish(*end);
      seen_[k].answered = true;
      reader_.begin();
    }
    if (fault != nullptr && fault->from == controller) {
      seen_[k].fault = fault->code;
      if (fault->code != 0) report_fault(DriveTrouble::kDriveFault);
    }
  }
}

void VescBase::send_order(std::size_t index, MotorOrder order, double speed_radps) noexcept {
  const AxisSetup& axis_setup = setup_.axes[index];
  Seen& seen = seen_[index];
  seen.torque_on = order == MotorOrder::kHold || order == MotorOrder::kRun;
  if (order == MotorOrder::kOff) {
    axis(index).obeys = false;
    send(set_current(axis_setup.controller, 0));
  } else {
    send(set_erpm(axis_setup.controller, to_erpm(speed_radps, axis_setup.electrical_turns_per_rad)));
  }
  send(ask_fault(axis_setup.controller, setup_.own));
}

// Whether a frame is taken changes nothing: there is no third way, and it is said again as long as it has to be.
void Stopper::brake() noexcept {
  for (const std::uint8_t controller : controllers_) static_cast<void>(bus_.send(set_erpm(controller, 0)));
}

}  // namespace jaywalk::vesc
