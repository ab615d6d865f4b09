#include "drivers/motor/motor_pair.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {

namespace {

/// Frames that one tick takes in: a bus at 1 Mbit/s brings some 9000 a second.
constexpr int kMostAtOnce = 512;

}  // namespace

WheelState MotorPair::latest() noexcept {
  receive();
  watch();
  wheels_.trouble = trouble_;
  wheels_.ready = trouble_ == DriveTrouble::kNone && armed_ && !awaits_zero_ && is_enabled();
  return wheels_;
}

void MotorPair::receive() noexcept {
  ReceivedFrame received;
  for (int taken = 0; taken < kMostAtOnce && bus_.receive(received); ++taken) {
    take(received);
    publish(received.stamp);
  }
}

void MotorPair::publish(Time stamp) noexcept {
  const auto complete = [](const MotorAxis& a) { return a.fresh_position && a.fresh_speed; };
  if (!std::all_of(axes_.begin(), axes_.end(), complete)) return;
  wheels_ = {.stamp = stamp,
             .sequence = wheels_.sequence + 1,
             .left_rad = axes_[0].turned_rad,
             .right_rad = axes_[1].turned_rad,
             .left_radps = axes_[0].speed_radps,
             .right_radps = axes_[1].speed_radps};
  for (MotorAxis& a : axes_) a.fresh_position = a.fresh_speed = false;
}

void MotorPair::watch() noexcept {
  if (!armed_) return;
  if (!bus_watch_.is_well(bus_.health())) latch(DriveTrouble::kBusUnwell);
  for (MotorAxis& a : axes_) {
    if (!awaits_zero_ && age(a.heard, clock_.now()) > silence_limit_) latch(DriveTrouble::kDriveSilent);
    if (a.was_enabled && !a.obeys) latch(DriveTrouble::kLeftOperation);
    a.was_enabled = a.obeys && !awaits_zero_;
  }
}

// The first trouble is the one worth knowing: the others follow from it.
void MotorPair::latch(DriveTrouble trouble) noexcept {
  if (trouble_ == DriveTrouble::kNone) trouble_ = trouble;
}

void MotorPair::report_fault(DriveTrouble trouble) noexcept {
  if (armed_ && !awaits_zero_ && clock_.now() > settled_) latch(trouble);
}

void MotorPair::begin_watch() noexcept {
  armed_ = true;
  bus_watch_.begin(bus_.health());
}

void MotorPair::reset() noexcept {
  trouble_ = DriveTrouble::kNone;
  awaits_zero_ = true;
  for (MotorAxis& a : axes_) a.was_enabled = false;
}

// What a motor complains of while nobody commands it (its watchdog) is forgotten here; what remains is a fault.
void MotorPair::begin_enabling() noexcept {
  awaits_zero_ = false;
  settled_ = clock_.now() + settling_;
  for (std::size_t k = 0; k < axes_.size(); ++k) send_reset(k);
}

bool MotorPair::is_enabled() const noexcept {
  return std::all_of(axes_.begin(), axes_.end(), [](const MotorAxis& a) { return a.obeys; });
}

MotorOrder MotorPair::order_now() const noexcept {
  if (trouble_ != DriveTrouble::kNone) return MotorOrder::kStop;
  if (!armed_ || awaits_zero_) return MotorOrder::kOff;
  return is_enabled() ? MotorOrder::kRun : MotorOrder::kHold;  // both wheels or none
}

void MotorPair::command(const WheelCommand& command) noexcept {
  const bool zero = command.left_radps == 0.0 && command.right_radps == 0.0;
  if (awaits_zero_ && zero && armed_ && trouble_ == DriveTrouble::kNone) begin_enabling();
  const MotorOrder order = order_now();
  const bool finite = std::isfinite(command.left_radps) && std::isfinite(command.right_radps);
  const bool moves = order == MotorOrder::kRun && finite;
  send_order(0, order, moves ? command.left_radps : 0.0);
  send_order(1, order, moves ? command.right_radps : 0.0);
}

void MotorPair::disarm() noexcept {
  awaits_zero_ = true;
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    axes_[k].was_enabled = false;  // it leaves operation because it was asked to
    send_order(k, MotorOrder::kOff, 0.0);
  }
  receive();
}

void MotorPair::send(const CanFrame& frame) noexcept {
  if (bus_.send(frame) != SendResult::kQueued) latch(DriveTrouble::kBusRefused);
}

void MotorPair::pass_time() {
  clock_.sleep_until(clock_.now() + std::chrono::milliseconds(1));
  receive();
}

}  // namespace jaywalk
