#pragma once
#include <algorithm>
#include <cstdint>

#include "drivers/can/can_bus.h"

namespace jaywalk::emulators {

/// `from`, moved towards `to` by `most` at most.
[[nodiscard]] inline double ramped(double from, double to, double most) noexcept {
  return from < to ? std::min(from + most, to) : std::max(from - most, to);
}

/// Parts common to emulated motor controllers on a CAN bus: cable, encoder, and faults to order. In the drive's units.
class MotorNode {
 public:
  /// No more frames out, as when its cable is pulled; frames in are lost too.
  void pull_cable() noexcept { connected_ = false; }
  void plug_cable() noexcept { connected_ = true; }
  /// No more frames out; it goes on hearing and obeying.
  void mute() noexcept { muted_ = true; }
  /// Goes on with the speed that it was told last; everything else is obeyed.
  void stick() noexcept { stuck_ = true; }
  /// Obeys nothing any more, but what it is told feeds its watchdog.
  void go_deaf() noexcept { deaf_ = true; }
  /// What its encoder shows from now on, where a motor of the world's own follows velocity().
  void measure(double velocity, double position) noexcept {
    has_encoder_ = true;
    encoder_velocity_ = velocity;
    encoder_position_ = position;
  }
  /// When it was last told something that feeds its watchdog; kNever before the first time.
  [[nodiscard]] Time heard_controller() const noexcept { return fed_; }

 protected:
  /// `bus` outlives it.
  MotorNode(CanBus& bus, std::uint8_t node) noexcept : bus_(bus), node_(node) {}

  void send(const CanFrame& frame) noexcept {
    if (connected_ && !muted_) static_cast<void>(bus_.send(frame));
  }
  /// Power lost and back: its counter begins at zero.
  void forget() noexcept {
    stuck_ = deaf_ = muted_ = false;
    fed_ = kNever;
    position_ = 0.0;
    encoder_zero_ = encoder_position_;
  }
  [[nodiscard]] double felt_position() const noexcept {
    return has_encoder_ ? encoder_position_ - encoder_zero_ : position_;
  }

  CanBus& bus_;
  std::uint8_t node_;
  bool connected_ = true, muted_ = false, stuck_ = false, deaf_ = false, has_encoder_ = false;
  double position_ = 0.0, encoder_velocity_ = 0.0, encoder_position_ = 0.0, encoder_zero_ = 0.0;
  Time stepped_ = kNever, fed_ = kNever;
};

}  // namespace jaywalk::emulators
