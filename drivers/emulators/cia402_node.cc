#include "drivers/emulators/cia402_node.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "drivers/wire/byte_reader.h"

namespace jaywalk::emulators {

namespace {

constexpr std::uint32_t kPdoOff = 0x80000000;

double ramped(double from, double to, double most) noexcept {
  return from < to ? std::min(from + most, to) : std::max(from - most, to);
}

}  // namespace

void Cia402Node::step(Time now) noexcept {
  ReceivedFrame received;
  while (bus_.receive(received)) {
    if (connected_) take(received.frame, now);
  }
  watch_controller(now);
  if (stepped_ != kNever) move(to_seconds(now - stepped_));
  stepped_ = now;
  say_heartbeat(now);
}

void Cia402Node::take(const CanFrame& frame, Time now) noexcept {
  if (const auto answered = objects_.answer(node_, frame)) {
    static_cast<void>(bus_.send(*answered));
    return;
  }
  const std::uint32_t watched = objects_.value({0x1016, 1});
  if (frame.id == 0x700 + ((watched >> 16U) & 0x7FU)) heard_controller_ = now;
  if (frame.id == 0x000 && frame.size == 2 && (frame.bytes[1] == node_ || frame.bytes[1] == 0)) {
    operational_ = frame.bytes[0] == 0x01;
  }
  if (!operational_) return;
  if (frame.id == objects_.value({0x1400, 1}) && frame.size == 6) {
    pending_controlword_ = wire::little_endian<std::uint16_t>(frame.payload());
    pending_target_ = static_cast<std::int32_t>(wire::little_endian<std::uint32_t>(frame.payload().subspan(2)));
  }
  if (frame.id == 0x080) on_sync();
}

void Cia402Node::on_sync() noexcept {
  obey(pending_controlword_);
  objects_.set({0x60FF, 0}, static_cast<std::uint32_t>(pending_target_));
  const double felt = has_encoder_ ? encoder_velocity_ : velocity_;
  const double stands_at = has_encoder_ ? encoder_position_ : position_;
  const auto speed = static_cast<std::uint32_t>(static_cast<std::int32_t>(felt));
  const auto turned = static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(stands_at)));
  const std::uint32_t first = objects_.value({0x1800, 1});
  const std::uint32_t second = objects_.value({0x1801, 1});
  if ((first & kPdoOff) == 0) send(first, statusword() | static_cast<std::uint64_t>(speed) << 16U, 6);
  if ((second & kPdoOff) == 0) send(second, turned, 4);
}

// The transitions that a controlword asks for (CiA 402): bit 0 switch on, 1 voltage, 2 no quick stop, 3 enable, 7
// reset.
void Cia402Node::obey(std::uint16_t controlword) noexcept {
  const bool reset_edge = (controlword & 0x80) != 0 && (last_controlword_ & 0x80) == 0;
  last_controlword_ = controlword;
  if (state_ == State::kFaultReaction) return;
  if (state_ == State::kFault) {
    if (reset_edge) state_ = State::kSwitchOnDisabled;
    return;
  }
  const unsigned low = controlword & 0x0FU;
  if ((low & 2U) == 0) {
    state_ = State::kSwitchOnDisabled;
  } else if ((low & 4U) == 0) {
    if (state_ == State::kOperationEnabled) state_ = State::kQuickStop;
    if (state_ != State::kQuickStop) state_ = State::kSwitchOnDisabled;
  } else if (state_ == State::kQuickStop) {
    return;
  } else if ((low & 1U) == 0) {
    state_ = State::kReady;
  } else if (low == 0x7 && state_ != State::kSwitchOnDisabled) {
    state_ = State::kSwitchedOn;
  } else if (low == 0xF && state_ == State::kSwitchedOn) {
    state_ = State::kOperationEnabled;
  }
}

std::uint16_t Cia402Node::statusword() const noexcept {
  switch (state_) {
    case State::kSwitchOnDisabled:
      return 0x0250;
    case State::kReady:
      return 0x0231;
    case State::kSwitchedOn:
      return 0x0233;
    case State::kOperationEnabled:
      return 0x0237;
    case State::kQuickStop:
      return 0x0217;
    case State::kFaultReaction:
      return 0x021F;
    case State::kFault:
      return 0x0218;
  }
  return 0;
}

// CiA 301: watching begins with the first heartbeat heard.
void Cia402Node::watch_controller(Time now) noexcept {
  const std::uint32_t entry = objects_.value({0x1016, 1});
  const auto limit = std::chrono::milliseconds(entry & 0xFFFFU);
  if (entry == 0 || heard_controller_ == kNever || now - heard_controller_ <= limit) return;
  heard_controller_ = kNever;
  lose_controller();
}

void Cia402Node::lose_controller() noexcept {
  send_emergency(0x8130);
  if (state_ != State::kOperationEnabled) return;
  switch (objects_.value({0x6007, 0})) {
    case 1:
      state_ = State::kFaultReaction;
      break;
    case 2:
      state_ = State::kSwitchOnDisabled;
      break;
    case 3:
      state_ = State::kQuickStop;
      break;
    default:
      break;  // it drives on, as drives do that nobody told otherwise
  }
}

void Cia402Node::measure(double velocity, double position) noexcept {
  has_encoder_ = true;
  encoder_velocity_ = velocity;
  encoder_position_ = position;
}

std::string_view Cia402Node::state_name() const noexcept {
  constexpr std::array<std::string_view, 7> kNames{"off",        "ready",          "switched_on", "enabled",
                                                   "quick_stop", "fault_reaction", "fault"};
  return kNames[static_cast<std::size_t>(state_)];
}

void Cia402Node::raise_fault(std::uint16_t error_code) noexcept {
  state_ = State::kFaultReaction;
  send_emergency(error_code);
}

void Cia402Node::move(double seconds) noexcept {
  const double before = velocity_;
  const auto ramp = [&](std::uint16_t index) { return static_cast<double>(objects_.value({index, 0})) * seconds; };
  const double target = static_cast<std::int32_t>(objects_.value({0x60FF, 0}));
  switch (state_) {
    case State::kOperationEnabled:
      velocity_ = ramped(velocity_, target, std::fabs(target) > std::fabs(velocity_) ? ramp(0x6083) : ramp(0x6084));
      break;
    case State::kQuickStop:
    case State::kFaultReaction:
      velocity_ = ramped(velocity_, 0.0, ramp(0x6085));
      break;
    default:
      velocity_ = ramped(velocity_, 0.0, ramp(0x6084) / 10.0);  // it rolls out
      break;
  }
  position_ += 0.5 * (before + velocity_) * seconds;
  if (velocity_ != 0.0) return;
  if (state_ == State::kQuickStop && objects_.value({0x605A, 0}) <= 3) state_ = State::kSwitchOnDisabled;
  if (state_ == State::kFaultReaction) state_ = State::kFault;
}

void Cia402Node::say_heartbeat(Time now) noexcept {
  const auto period = std::chrono::milliseconds(objects_.value({0x1017, 0}));
  if (period.count() == 0 || (said_heartbeat_ != kNever && now - said_heartbeat_ < period)) return;
  said_heartbeat_ = now;
  send(0x700U + node_, operational_ ? 0x05 : 0x7F, 1);
}

void Cia402Node::send_emergency(std::uint16_t error_code) noexcept { send(0x080U + node_, error_code, 8); }

void Cia402Node::send(std::uint32_t id, std::uint64_t word, std::uint8_t size) noexcept {
  if (!connected_) return;
  CanFrame frame;
  frame.id = id;
  frame.size = size;
  wire::put_little_endian(word, frame.bytes);
  static_cast<void>(bus_.send(frame));
}

}  // namespace jaywalk::emulators
