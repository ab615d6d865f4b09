#include "drivers/canopen/cia402.h"

#include "drivers/canopen/drive_proof.h"
#include "drivers/wire/byte_reader.h"

namespace jaywalk::canopen {
namespace {

constexpr std::uint32_t kNmtId = 0x000, kSyncId = 0x080, kEmergencyBase = 0x080, kHeartbeatBase = 0x700;

/// Returns the node number, 1 to 127, of a data frame with identifier `base` + node; 0 for any other frame.
std::uint8_t node_of(const CanFrame& frame, std::uint32_t base) noexcept {
  if (frame.extended || frame.remote || frame.id <= base || frame.id > base + 127) return 0;
  return static_cast<std::uint8_t>(frame.id - base);
}

constexpr std::uint16_t kDisableVoltage = 0x0000, kQuickStop = 0x0002, kShutdown = 0x0006, kSwitchOn = 0x0007,
                        kEnableOperation = 0x000F, kFaultReset = 0x0080;

struct Pattern {
  std::uint16_t mask;
  std::uint16_t value;
  DriveState state;
};

// Bits 0 to 3 and 6 always count; bit 5 (0: quick stop) only where the standard's table gives it.
constexpr std::array kPatterns{
    Pattern{0x4F, 0x00, DriveState::kNotReady},
    Pattern{0x4F, 0x40, DriveState::kSwitchOnDisabled},
    Pattern{0x6F, 0x21, DriveState::kReadyToSwitchOn},
    Pattern{0x6F, 0x23, DriveState::kSwitchedOn},
    Pattern{0x6F, 0x27, DriveState::kOperationEnabled},
    Pattern{0x6F, 0x07, DriveState::kQuickStopActive},
    Pattern{0x4F, 0x0F, DriveState::kFaultReactionActive},
    Pattern{0x4F, 0x08, DriveState::kFault},
};

std::uint16_t step_to_enabled(DriveState state) noexcept {
  switch (state) {
    case DriveState::kSwitchOnDisabled: return kShutdown;
    case DriveState::kReadyToSwitchOn: return kSwitchOn;
    case DriveState::kSwitchedOn:
    case DriveState::kOperationEnabled: return kEnableOperation;
    default: return kDisableVoltage;
  }
}

}  // namespace

std::size_t length_of(const PdoMapping& mapping) noexcept {
  std::size_t length = 0;
  for (const MappedObject& object : mapping) length += object.bytes;
  return length;
}

std::optional<CanFrame> pack(const PdoMapping& mapping, std::uint32_t id,
                             std::span<const std::uint32_t> values) noexcept {
  if (values.size() != mapping.size() || length_of(mapping) > 8) return std::nullopt;
  CanFrame frame;
  frame.id = id;
  for (std::size_t i = 0; i < mapping.size(); ++i)
    for (std::uint8_t byte = 0; byte < mapping[i].bytes && byte < 4; ++byte)
      frame.bytes[frame.size++] = static_cast<std::uint8_t>(values[i] >> (8U * byte));
  return frame;
}

std::optional<FixedVector<std::uint32_t, 8>> unpack(const PdoMapping& mapping, const CanFrame& frame) noexcept {
  if (frame.remote || frame.size > 8 || length_of(mapping) > frame.size) return std::nullopt;
  FixedVector<std::uint32_t, 8> values;
  std::size_t at = 0;
  for (const MappedObject& object : mapping) {
    std::uint32_t value = 0;
    for (std::uint8_t byte = 0; byte < object.bytes && byte < 4; ++byte)
      value |= static_cast<std::uint32_t>(frame.bytes[at++]) << (8U * byte);
    if (!values.push_back(value)) return std::nullopt;
  }
  return values;
}

// CiA 301: a PDO must be off (bit 31 of its COB-ID) and its mapping empty while it is mapped.
bool append_setup(const PdoSetup& setup, ObjectWrites& writes) noexcept {
  constexpr std::uint32_t kOff = 0x80000000;
  bool fits = writes.push_back({{setup.communication_index, 1}, setup.id | kOff, 4});
  fits = fits && writes.push_back({{setup.mapping_index, 0}, 0, 1});
  std::uint8_t entry = 0;
  for (const MappedObject& object : setup.mapping)
    fits = fits && writes.push_back({{setup.mapping_index, ++entry}, object.mapping_word(), 4});
  fits = fits && writes.push_back({{setup.mapping_index, 0}, entry, 1});
  fits = fits && writes.push_back({{setup.communication_index, 2}, setup.transmission_type, 1});
  return fits && writes.push_back({{setup.communication_index, 1}, setup.id, 4});
}

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
    case NmtState::kPreOperational: return Heartbeat{node, state};
  }
  return std::nullopt;
}

std::optional<Emergency> decode_emergency(const CanFrame& frame) noexcept {
  const std::uint8_t node = node_of(frame, kEmergencyBase);
  if (node == 0 || frame.size != 8) return std::nullopt;
  return Emergency{node, wire::little_endian<std::uint16_t>(frame.payload())};
}

std::string_view emergency_class(std::uint16_t error_code) noexcept {
  switch (error_code >> 12U) {
    case 0x0: return "no error";
    case 0x1: return "generic";
    case 0x2: return "current";
    case 0x3: return "voltage";
    case 0x4: return "temperature";
    case 0x5: return "device hardware";
    case 0x6: return "device software";
    case 0x7: return "additional modules";
    case 0x8: return "monitoring";
    case 0x9: return "external";
    case 0xF: return "device specific";
    default: return "reserved";
  }
}

DriveState state_of(std::uint16_t statusword) noexcept {
  for (const Pattern& pattern : kPatterns)
    if ((statusword & pattern.mask) == pattern.value) return pattern.state;
  return DriveState::kUnknown;
}

std::string_view name(DriveState state) noexcept {
  constexpr std::array<std::string_view, 9> kNames{
      "not ready to switch on", "switch on disabled", "ready to switch on",    "switched on",
      "operation enabled",      "quick stop active",  "fault reaction active", "fault",
      "unknown state"};
  const auto index = static_cast<std::size_t>(state);
  return index < kNames.size() ? kNames[index] : kNames.back();
}

std::uint16_t controlword_towards(DriveGoal goal, DriveState state, bool reset_fault) noexcept {
  if (state == DriveState::kFault) return reset_fault ? kFaultReset : kDisableVoltage;
  switch (goal) {
    case DriveGoal::kEnabled: return step_to_enabled(state);
    case DriveGoal::kQuickStop:
      return kQuickStop;  // in every state: what is known of the drive may be old, and it must brake, not roll
    case DriveGoal::kOff: break;
  }
  return kDisableVoltage;
}

std::vector<CanFrame> quick_stop_frames(const std::array<std::uint8_t, 2>& nodes) {
  const std::array<std::uint32_t, 2> stop{
      controlword_towards(DriveGoal::kQuickStop, DriveState::kOperationEnabled, false), 0};
  std::vector<CanFrame> frames;
  for (const std::uint8_t node : nodes)
    frames.push_back(pack(command_pdo(node).mapping, 0x200U + node, stop).value_or(CanFrame{}));
  frames.push_back(sync_frame());
  return frames;
}

}  // namespace jaywalk::canopen
