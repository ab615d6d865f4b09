#include "hil/emulators/odrive_node.h"

#include <bit>

#include "drivers/wire/byte_reader.h"

namespace jaywalk::emulators {
namespace {

constexpr double kRamp_turns_per_s2 = 20.0;
constexpr double kRollOut_turns_per_s2 = 2.0;  ///< without torque
constexpr std::uint32_t kEstop = 0x02000000;
constexpr Duration kEstimatesPeriod = std::chrono::milliseconds(10);

bool is_due(Time& said, Duration period, Time now) noexcept {
  if (said != kNever && now - said < period) return false;
  said = now;
  return true;
}

}  // namespace

void OdriveNode::step(Time now) noexcept {
  ReceivedFrame received;
  while (bus_.receive(received))
    if (connected_) take(received.frame, now);
  watch(now);
  if (stepped_ != kNever) move(to_seconds(now - stepped_));
  stepped_ = now;
  say(now);
}

void OdriveNode::take(const CanFrame& frame, Time now) noexcept {
  if (frame.extended || frame.id >> 5U != node_) return;
  fed_ = now;  // whatever is said to it feeds the watchdog
  if (deaf_) return;
  const auto word = wire::little_endian<std::uint32_t>(frame.bytes);
  switch (frame.id & 0x1FU) {
    case 0x02: return disarm(kEstop);
    case 0x07:
      if (word == 1) state_ = 1;
      if (word == 8 && errors_ == 0 && procedure_ == 0) state_ = 8;
      return;
    case 0x0B: control_mode_ = word; return;
    case 0x0D:
      if (!stuck_) target_ = static_cast<double>(std::bit_cast<float>(word));
      return;
    case 0x18: errors_ = lasting_error_; return;
    default: return;
  }
}

void OdriveNode::watch(Time now) noexcept {
  const bool expired = watchdog_ > Duration{0} && fed_ != kNever && now - fed_ > watchdog_;
  if (!expired || (errors_ & expired_) != 0) return;
  if (lies_)
    errors_ |= expired_;
  else
    disarm(expired_);
}

void OdriveNode::disarm(std::uint32_t error) noexcept {
  errors_ |= error;
  state_ = 1;
}

void OdriveNode::set_lasting_error(std::uint32_t error) noexcept {
  lasting_error_ = error;
  if (error != 0) disarm(error);
}

void OdriveNode::restart() noexcept {
  state_ = 1;
  errors_ = lasting_error_;
  target_ = 0.0;
  control_mode_ = 3;
  forget();
}

void OdriveNode::move(double seconds) noexcept {
  const double before = velocity_;
  const bool follows = state_ == 8 && control_mode_ == 2;
  velocity_ = follows ? ramped(velocity_, target_, kRamp_turns_per_s2 * seconds)
                      : ramped(velocity_, 0.0, kRollOut_turns_per_s2 * seconds);
  position_ += 0.5 * (before + velocity_) * seconds;
}

void OdriveNode::say(Time now) noexcept {
  if (is_due(said_heartbeat_, kHeartbeatPeriod, now))
    send(0x01, errors_, state_ | static_cast<std::uint32_t>(procedure_) << 8U);
  if (!estimates_ || !is_due(said_estimates_, kEstimatesPeriod, now)) return;
  send(0x09, std::bit_cast<std::uint32_t>(static_cast<float>(felt_position())),
       std::bit_cast<std::uint32_t>(static_cast<float>(has_encoder_ ? encoder_velocity_ : velocity_)));
}

void OdriveNode::send(std::uint32_t command, std::uint32_t first, std::uint32_t second) noexcept {
  CanFrame frame;
  frame.id = static_cast<std::uint32_t>(node_) << 5U | command;
  frame.size = 8;
  wire::put_little_endian(first, frame.bytes);
  wire::put_little_endian(second, std::span(frame.bytes).subspan(4));
  MotorNode::send(frame);
}

}  // namespace jaywalk::emulators
