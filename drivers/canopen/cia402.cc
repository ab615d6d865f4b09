#include "drivers/canopen/cia402.h"

#include "drivers/wire/byte_reader.h"

namespace jaywalk::canopen {
namespace {

constexpr std::uint32_t kNmtId = 0x000, kSyncId = 0x080, kEmergencyBase = 0x080, kHeartbeatBase = 0x700;

bool is_data(const CanFrame& frame, std::uint32_t id) noexcept {
  return !frame.extended && !frame.remote && frame.id == id;
}

constexpr std::uint16_t kDisableVoltage = 0x0000, kQuickStop = 0x0002, kShutdown = 0x0006, kSwitchOn = 0x0007,
                        kEnableOperation = 0x000F, kFaultReset = 0x0080;

struct Pattern {
  std::uint16_t mask, value;
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

CanFrame nmt_frame(NmtCommand command, std::uint8_t node) noexcept {
  return {.id = kNmtId, .size = 2, .bytes = {static_cast<std::uint8_t>(command), node}};
}

CanFrame sync_frame() noexcept { return {.id = kSyncId}; }

CanFrame heartbeat_frame(std::uint8_t node, NmtState state) noexcept {
  return {.id = kHeartbeatBase + node, .size = 1, .bytes = {static_cast<std::uint8_t>(state)}};
}

std::optional<NmtState> heartbeat_in(const CanFrame& frame, std::uint8_t node) noexcept {
  if (!is_data(frame, kHeartbeatBase + node) || frame.size == 0) return std::nullopt;
  const auto state = static_cast<NmtState>(frame.bytes[0]);
  switch (state) {
    case NmtState::kBootUp:
    case NmtState::kStopped:
    case NmtState::kOperational:
    case NmtState::kPreOperational: return state;
  }
  return std::nullopt;
}

std::optional<std::uint16_t> emergency_in(const CanFrame& frame, std::uint8_t node) noexcept {
  if (!is_data(frame, kEmergencyBase + node) || frame.size != 8) return std::nullopt;
  return wire::little_endian<std::uint16_t>(frame.payload());
}

DriveState state_of(std::uint16_t statusword) noexcept {
  for (const Pattern& pattern : kPatterns)
    if ((statusword & pattern.mask) == pattern.value) return pattern.state;
  return DriveState::kUnknown;
}

std::uint16_t controlword_towards(DriveGoal goal, DriveState state, bool reset_fault) noexcept {
  if (state == DriveState::kFault) return reset_fault ? kFaultReset : kDisableVoltage;
  if (goal == DriveGoal::kEnabled) return step_to_enabled(state);
  // A quick stop in every state: what is known of the drive may be old, and it must brake, not roll.
  return goal == DriveGoal::kQuickStop ? kQuickStop : kDisableVoltage;
}

CanFrame command_frame(std::uint8_t node, std::uint16_t controlword, std::int32_t target) noexcept {
  CanFrame frame{.id = 0x200U + node, .size = 6};
  wire::put_little_endian(controlword, frame.bytes);
  wire::put_little_endian(static_cast<std::uint32_t>(target), std::span(frame.bytes).subspan(2));
  return frame;
}

std::vector<CanFrame> quick_stop_frames(const std::array<std::uint8_t, 2>& nodes) {
  return {command_frame(nodes[0], kQuickStop, 0), command_frame(nodes[1], kQuickStop, 0), sync_frame()};
}

}  // namespace jaywalk::canopen
