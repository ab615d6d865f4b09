#pragma once
// The state machine of a drive (CiA 402, IEC 61800-7-201): what the statusword says, what the controlword asks.
#include <array>
#include <cstdint>
#include <string_view>

#include "drivers/can/can_bus.h"
#include "drivers/canopen/pdo.h"
#include "drivers/wired_drive.h"

namespace jaywalk::canopen {

inline constexpr ObjectAddress kControlword{0x6040, 0}, kStatusword{0x6041, 0}, kModeWanted{0x6060, 0},
    kModeShown{0x6061, 0}, kPosition{0x6064, 0}, kVelocity{0x606C, 0}, kProfileAcceleration{0x6083, 0},
    kProfileDeceleration{0x6084, 0}, kQuickStopDeceleration{0x6085, 0}, kTargetVelocity{0x60FF, 0};
inline constexpr ObjectAddress kAbortConnection{0x6007, 0}, kQuickStopOption{0x605A, 0}, kShutdownOption{0x605B, 0},
    kDisableOption{0x605C, 0}, kHaltOption{0x605D, 0}, kFaultOption{0x605E, 0};
inline constexpr std::uint8_t kProfileVelocityMode = 3;

enum class DriveState : std::uint8_t {
  kNotReady,
  kSwitchOnDisabled,
  kReadyToSwitchOn,
  kSwitchedOn,
  kOperationEnabled,
  kQuickStopActive,
  kFaultReactionActive,
  kFault,
  kUnknown  ///< a statusword that the standard does not have
};

[[nodiscard]] DriveState state_of(std::uint16_t statusword) noexcept;
[[nodiscard]] std::string_view name(DriveState state) noexcept;

enum class DriveGoal : std::uint8_t {
  kOff,       ///< no torque: the wheels can be pushed unless a brake holds them
  kEnabled,   ///< follows the target velocity
  kQuickStop  ///< brakes by 6085h and what 605Ah says
};

/// The controlword that brings a drive in `state` one step towards `goal`.
///
/// A fault is left only by a rising edge of the reset bit: it is set where `reset_fault`, which is to be true for one
/// call after a person's reset. A quick stop that was asked for is not gone back on: its way leads through kOff.
[[nodiscard]] std::uint16_t controlword_towards(DriveGoal goal, DriveState state, bool reset_fault) noexcept;

/// Tells two CiA 402 drives to quick-stop, over a place of its own on their bus.
class QuickStopper final : public EmergencyBrake {
 public:
  /// `bus` outlives it and belongs to the thread that brakes. The drives are set up as CanopenDriveBase does.
  QuickStopper(CanBus& bus, std::array<std::uint8_t, 2> nodes) noexcept;
  void brake() noexcept override;

 private:
  CanBus& bus_;
  std::array<std::uint8_t, 2> nodes_;
  std::array<PdoMapping, 2> mappings_;
};

}  // namespace jaywalk::canopen
