#include "hil/emulators/cia402_node.h"

#include <array>
#include <cmath>

#include "drivers/wire/byte_reader.h"

namespace jaywalk::emulators {
namespace {

constexpr std::uint32_t kPdoOff = 0x80000000, kIdentifier = 0x7FF;

struct StateRow {
  std::string_view name;
  std::uint16_t statusword;
};

/// In the order of State.
constexpr std::array<StateRow, 7> kStates{{{"off", 0x0250},
                                           {"ready", 0x0231},
                                           {"switched_on", 0x0233},
                                           {"enabled", 0x0237},
                                           {"quick_stop", 0x0217},
                                           {"fault_reaction", 0x021F},
                                           {"fault", 0x0218}}};

}  // namespace

void Cia402Node::step(Time now) {
  if (!booted_) boot();
  if (!is_enabled()) enabled_ = kNever;
  if (is_enabled() && enabled_ == kNever) enabled_ = now;
  show();
  MotorNode::step(now);
}

void Cia402Node::boot() noexcept {
  booted_ = true;
  network_ = starts_by_itself_ ? Network::kOperational : Network::kPreOperational;
  send(0x700U + node_, 0x00, heartbeat_size_);
}

void Cia402Node::restart() noexcept {
  objects_.restore(true);
  state_ = State::kSwitchOnDisabled;
  fed_ = said_heartbeat_ = kNever;
  pending_controlword_ = last_controlword_ = 0;
  pending_target_ = 0;
  booted_ = false;
}

void Cia402Node::take(const CanFrame& frame, Time now) noexcept {
  if (frame.extended || frame.remote) return;
  const std::uint32_t watched = objects_.value({0x1016, 1});
  if (frame.id == 0x700 + ((watched >> 16U) & 0x7FU)) fed_ = now;
  const bool is_addressed = frame.size == 2 && (frame.bytes[1] == node_ || frame.bytes[1] == 0);
  if (frame.id == 0x000 && is_addressed) return take_network_command(frame.bytes[0]);
  if (network_ == Network::kStopped || take_request(frame) || network_ != Network::kOperational) return;
  if (frame.id == objects_.value({0x1400, 1})) take_targets(frame);
  if (frame.id == 0x080) on_sync();
}

// CiA 301: start, stop, enter pre-operational, reset node, reset communication. The latter clears the heartbeat
// consumer and leaves the motor as it is.
void Cia402Node::take_network_command(std::uint8_t command) noexcept {
  switch (command) {
    case 0x01: network_ = Network::kOperational; return;
    case 0x02: network_ = Network::kStopped; return;
    case 0x80: network_ = Network::kPreOperational; return;
    case 0x81: return restart();
    case 0x82:
      objects_.restore(false);
      fed_ = kNever;
      booted_ = false;
      return;
    default: return;
  }
}

/// Whether it was an SDO request to this node. A controlword that is written so is obeyed at once.
bool Cia402Node::take_request(const CanFrame& frame) noexcept {
  const auto answered = objects_.answer(node_, frame);
  if (!answered) return false;
  MotorNode::send(*answered);
  const bool was_written = answered->bytes[0] == 0x60;
  if (was_written && wire::little_endian<std::uint16_t>(frame.payload().subspan(1)) == 0x6040)
    obey(wire::little_endian<std::uint16_t>(frame.payload().subspan(4)));
  return true;
}

/// Receive PDO 1, as 1600h maps it.
void Cia402Node::take_targets(const CanFrame& frame) noexcept {
  std::uint64_t word = 0;
  for (std::uint8_t at = 0; at < frame.size; ++at) word |= static_cast<std::uint64_t>(frame.bytes[at]) << (8U * at);
  for (std::uint8_t entry = 1; entry <= objects_.value({0x1600, 0}); ++entry) {
    const std::uint32_t mapped = objects_.value({0x1600, entry});
    if (mapped >> 16U == 0x6040) pending_controlword_ = static_cast<std::uint16_t>(word);
    if (mapped >> 16U == 0x60FF) pending_target_ = static_cast<std::int32_t>(static_cast<std::uint32_t>(word));
    word >>= mapped & 0x3FU;
  }
}

void Cia402Node::on_sync() noexcept {
  obey(pending_controlword_);
  if (!stuck_) objects_.set({0x60FF, 0}, static_cast<std::uint32_t>(pending_target_));
  show();
  transmit(0x1800, 0x1A00);
  transmit(0x1801, 0x1A01);
}

void Cia402Node::show() noexcept {
  const double stands_at = felt_position() + slipped_;
  objects_.set({0x6041, 0}, kStates[static_cast<std::size_t>(state_)].statusword);
  objects_.set({0x606C, 0}, static_cast<std::uint32_t>(static_cast<std::int32_t>(felt_velocity())));
  objects_.set({0x6064, 0}, static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(stands_at))));
  objects_.set({0x6061, 0}, shown_mode());
}

std::uint32_t Cia402Node::shown_mode() const noexcept {
  if (kept_mode_) return *kept_mode_;
  const bool shows = !mode_delay_ || (enabled_ != kNever && stepped_ - enabled_ >= *mode_delay_);
  return shows ? objects_.value({0x6060, 0}) : 0;
}

void Cia402Node::transmit(std::uint16_t communication, std::uint16_t mapping) noexcept {
  const std::uint32_t id = objects_.value({communication, 1});
  if ((id & kPdoOff) != 0 || !reports_) return;
  std::uint64_t word = 0;
  unsigned bits = 0;
  for (std::uint8_t entry = 1; entry <= objects_.value({mapping, 0}); ++entry) {
    const std::uint32_t mapped = objects_.value({mapping, entry});
    const canopen::ObjectAddress address{static_cast<std::uint16_t>(mapped >> 16U),
                                         static_cast<std::uint8_t>(mapped >> 8U)};
    word |= static_cast<std::uint64_t>(objects_.value(address)) << bits;
    bits += mapped & 0x3FU;
  }
  send(id & kIdentifier, word, static_cast<std::uint8_t>(bits / 8));
}

// The transitions that a controlword asks for (CiA 402): bit 0 switch on, 1 voltage, 2 no quick stop, 3 enable, 7
// reset.
void Cia402Node::obey(std::uint16_t controlword) noexcept {
  const bool reset_edge = (controlword & 0x80) != 0 && (last_controlword_ & 0x80) == 0;
  last_controlword_ = controlword;
  if (stuck_ || state_ == State::kFaultReaction) return;
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

// CiA 301: watching begins with the first heartbeat heard.
void Cia402Node::watch(Time now) noexcept {
  const std::uint32_t entry = objects_.value({0x1016, 1});
  const auto limit = std::chrono::milliseconds(entry & 0xFFFFU);
  if (entry == 0 || fed_ == kNever || now - fed_ <= limit) return;
  fed_ = kNever;
  lose_controller();
}

// 1029h: a communication error takes it out of Operational, unless it was set otherwise.
void Cia402Node::lose_controller() noexcept {
  send_emergency(0x8130);
  if (network_ == Network::kOperational && objects_.value({0x1029, 1}) == 0) network_ = Network::kPreOperational;
  if (state_ != State::kOperationEnabled) return;
  switch (objects_.value({0x6007, 0})) {
    case 1: state_ = State::kFaultReaction; break;
    case 2: state_ = State::kSwitchOnDisabled; break;
    case 3: state_ = State::kQuickStop; break;
    default: break;  // it drives on, as drives do that nobody told otherwise
  }
}

std::string_view Cia402Node::state_name() const noexcept { return kStates[static_cast<std::size_t>(state_)].name; }

void Cia402Node::raise_fault(std::uint32_t error_code) noexcept {
  state_ = State::kFaultReaction;
  send_emergency(static_cast<std::uint16_t>(error_code));
}

void Cia402Node::move(double seconds) noexcept {
  const double before = velocity_;
  const auto ramp = [&](std::uint16_t index) { return static_cast<double>(objects_.value({index, 0})) * seconds; };
  const double target = static_cast<std::int32_t>(objects_.value({0x60FF, 0}));
  switch (state_) {
    case State::kOperationEnabled:
      friction_ = static_cast<double>(objects_.value({0x6084, 0})) / 10.0;
      velocity_ = ramped(velocity_, target, std::fabs(target) > std::fabs(velocity_) ? ramp(0x6083) : ramp(0x6084));
      break;
    case State::kQuickStop:
    case State::kFaultReaction: velocity_ = ramped(velocity_, 0.0, ramp(0x6085)); break;
    default:
      velocity_ = ramped(velocity_, 0.0, friction_ * seconds);  // it rolls out
      break;
  }
  position_ += 0.5 * (before + velocity_) * seconds;
  if (velocity_ != 0.0) return;
  if (state_ == State::kQuickStop && objects_.value({0x605A, 0}) <= 3) state_ = State::kSwitchOnDisabled;
  if (state_ == State::kFaultReaction) state_ = State::kFault;
}

void Cia402Node::say(Time now) noexcept {
  const auto period = std::chrono::milliseconds(objects_.value({0x1017, 0}));
  if (period.count() > 0 && is_due(said_heartbeat_, period, now))
    send(0x700U + node_, static_cast<std::uint64_t>(network_), heartbeat_size_);
}

void Cia402Node::send(std::uint32_t id, std::uint64_t word, std::uint8_t size) noexcept {
  CanFrame frame{.id = id, .size = size};
  wire::put_little_endian(word, frame.bytes);
  MotorNode::send(frame);
}

}  // namespace jaywalk::emulators
