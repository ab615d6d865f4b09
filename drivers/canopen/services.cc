#include "drivers/canopen/services.h"

#include <algorithm>

#include "drivers/wire/byte_reader.h"

namespace jaywalk::canopen {

namespace {

constexpr std::uint32_t kNmtId = 0x000, kSyncId = 0x080, kEmergencyBase = 0x080, kHeartbeatBase = 0x700;

/// The node of a frame whose identifier is `base` + node; 0 where it is none of them.
std::uint8_t node_of(const CanFrame& frame, std::uint32_t base) noexcept {
  if (frame.extended || frame.remote || frame.id <= base || frame.id > base + 127) return 0;
  return static_cast<std::uint8_t>(frame.id - base);
}

}  // namespace

CanFrame nmt_frame(NmtCommand command, std::uint8_t node) noexcept {
  CanFrame frame;
  frame.id = kNmtId;
  frame.size = 2;
  frame.bytes = {static_cast<std::uint8_t>(command), node};
  return frame;
}

CanFrame sync_frame() noexcept {
  CanFrame frame;
  frame.id = kSyncId;
  return frame;
}

CanFrame heartbeat_frame(std::uint8_t node, NmtState state) noexcept {
  CanFrame frame;
  frame.id = kHeartbeatBase + node;
  frame.size = 1;
  frame.bytes = {static_cast<std::uint8_t>(state)};
  return frame;
}

std::optional<Heartbeat> decode_heartbeat(const CanFrame& frame) noexcept {
  const std::uint8_t node = node_of(frame, kHeartbeatBase);
  if (node == 0 || frame.size == 0) return std::nullopt;
  const auto state = static_cast<NmtState>(frame.bytes[0]);
  switch (state) {
    case NmtState::kBootUp:
    case NmtState::kStopped:
    case NmtState::kOperational:
    case NmtState::kPreOperational:
      return Heartbeat{node, state};
  }
  return std::nullopt;
}

CanFrame emergency_frame(const Emergency& emergency) noexcept {
  CanFrame frame;
  frame.id = kEmergencyBase + emergency.node;
  frame.size = 8;
  wire::put_little_endian(emergency.error_code, frame.bytes);
  frame.bytes[2] = emergency.error_register;
  std::copy(emergency.maker_bytes.begin(), emergency.maker_bytes.end(), frame.bytes.begin() + 3);
  return frame;
}

std::optional<Emergency> decode_emergency(const CanFrame& frame) noexcept {
  const std::uint8_t node = node_of(frame, kEmergencyBase);
  if (node == 0 || frame.size != 8) return std::nullopt;
  Emergency emergency{node, wire::little_endian<std::uint16_t>(frame.payload()), frame.bytes[2], {}};
  std::copy(frame.bytes.begin() + 3, frame.bytes.end(), emergency.maker_bytes.begin());
  return emergency;
}

std::string_view emergency_class(std::uint16_t error_code) noexcept {
  switch (error_code >> 12U) {
    case 0x0:
      return "no error";
    case 0x1:
      return "generic";
    case 0x2:
      return "current";
    case 0x3:
      return "voltage";
    case 0x4:
      return "temperature";
    case 0x5:
      return "device hardware";
    case 0x6:
      return "device software";
    case 0x7:
      return "additional modules";
    case 0x8:
      return "monitoring";
    case 0x9:
      return "external";
    case 0xF:
      return "device specific";
    default:
      return "reserved";
  }
}

}  // namespace jaywalk::canopen
