#include "drivers/motor/odrive.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "drivers/wire/byte_reader.h"

namespace jaywalk::odrive {

namespace {

constexpr std::uint32_t kHeartbeat = 0x01, kEstop = 0x02, kGetError = 0x03, kWriteParameter = 0x04,
                        kSetAxisState = 0x07, kEstimates = 0x09, kSetControllerMode = 0x0B, kSetInputVelocity = 0x0D,
                        kReboot = 0x16, kClearErrors = 0x18, kUpdateMode = 0x1F;
constexpr std::uint32_t kVelocityControl = 2, kPassThrough = 1, kVelocityRamp = 2;

CanFrame command(std::uint8_t node, std::uint32_t number, std::uint8_t size, std::uint32_t first = 0,
                 std::uint32_t second = 0) noexcept {
  CanFrame frame;
  frame.id = static_cast<std::uint32_t>(node) << 5U | number;
  frame.size = size;
  wire::put_little_endian(first, frame.bytes);
  wire::put_little_endian(second, std::span(frame.bytes).subspan(4));
  return frame;
}

std::optional<Message> decode_estimates(std::uint8_t node, wire::ByteReader reader) noexcept {
  const auto position = std::bit_cast<float>(reader.little<std::uint32_t>());
  const auto velocity = std::bit_cast<float>(reader.little<std::uint32_t>());
  if (!reader.ok() || !std::isfinite(position) || !std::isfinite(velocity)) return std::nullopt;
  return Message{node, EncoderEstimates{position, velocity}};
}

}  // namespace

CanFrame set_axis_state(std::uint8_t node, AxisState state) noexcept {
  return command(node, kSetAxisState, 4, static_cast<std::uint32_t>(state));
}

CanFrame set_velocity_mode(std::uint8_t node, bool ramped) noexcept {
  return command(node, kSetControllerMode, 8, kVelocityControl, ramped ? kVelocityRamp : kPassThrough);
}

CanFrame set_velocity(std::uint8_t node, float turns_per_s) noexcept {
  return command(node, kSetInputVelocity, 8, std::bit_cast<std::uint32_t>(turns_per_s));
}

CanFrame emergency_stop(std::uint8_t node) noexcept { return command(node, kEstop, 0); }

CanFrame clear_errors(std::uint8_t node) noexcept { return command(node, kClearErrors, 1); }

// CANSimple's messages from the host (firmware 0.6, table of messages in its CAN guide): E-stop, parameter access, axis
// state, controller mode, inputs and limits (0Bh to 13h), reboot, clear errors, position, gains, firmware update.
bool is_order(const CanFrame& frame, std::uint8_t node) noexcept {
  if (frame.extended || frame.id >> 5U != node) return false;
  const std::uint32_t number = frame.id & 0x1FU;
  const bool is_input = number >= 0x0B && number <= 0x13;
  constexpr std::array<std::uint32_t, 9> kOthers{
      kEstop, kWriteParameter, kSetAxisState, kReboot, kClearErrors, 0x19, 0x1A, 0x1B, kUpdateMode};
  return frame.remote || is_input || std::find(kOthers.begin(), kOthers.end(), number) != kOthers.end();
}

std::optional<Message> decode(const CanFrame& frame) noexcept {
  if (frame.extended || frame.remote) return std::nullopt;
  const auto node = static_cast<std::uint8_t>(frame.id >> 5U);
  wire::ByteReader reader(frame.payload());
  switch (frame.id & 0x1FU) {
    case kHeartbeat: {
      const Heartbeat heartbeat{reader.little<std::uint32_t>(), reader.little<std::uint8_t>(),
                                reader.little<std::uint8_t>()};
      return reader.ok() ? std::optional(Message{node, heartbeat}) : std::nullopt;
    }
    case kGetError: {
      const Errors errors{reader.little<std::uint32_t>(), reader.little<std::uint32_t>()};
      return reader.ok() ? std::optional(Message{node, errors}) : std::nullopt;
    }
    case kEstimates:
      return decode_estimates(node, reader);
    default:
      return std::nullopt;
  }
}

}  // namespace jaywalk::odrive
