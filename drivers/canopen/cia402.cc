#include "drivers/canopen/cia402.h"

#include "drivers/canopen/drive_proof.h"

namespace jaywalk::canopen {
namespace {

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

QuickStopper::QuickStopper(CanBus& bus, std::array<std::uint8_t, 2> nodes) noexcept
    : bus_(bus), nodes_(nodes), mappings_{command_pdo(nodes[0]).mapping, command_pdo(nodes[1]).mapping} {}

// Whether a frame is taken changes nothing: there is no third way, and it is said again as long as it has to be.
void QuickStopper::brake() noexcept {
  const std::uint16_t stop = controlword_towards(DriveGoal::kQuickStop, DriveState::kOperationEnabled, false);
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const std::array<std::uint32_t, 2> values{stop, 0};
    if (const auto frame = pack(mappings_[k], 0x200U + nodes_[k], values)) static_cast<void>(bus_.send(*frame));
  }
  static_cast<void>(bus_.send(sync_frame()));
}

}  // namespace jaywalk::canopen
