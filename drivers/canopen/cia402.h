#pragma once
// The state machine of a drive (CiA 402, IEC 61800-7-201): what the statusword says, what the controlword asks.
#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/can/can_bus.h"

namespace jaywalk::canopen {

/// Where a value lives in a device's object dictionary.
struct ObjectAddress {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  auto operator<=>(const ObjectAddress&) const = default;
};

/// One write to a drive's object dictionary, of 1, 2 or 4 bytes.
struct ObjectWrite {
  ObjectAddress address;
  std::uint32_t value = 0;
  std::uint8_t bytes = 0;
  bool operator==(const ObjectWrite&) const = default;
};

/// The low bytes of `value` that an object has.
[[nodiscard]] constexpr std::uint32_t cut(std::uint32_t value, std::uint8_t bytes) noexcept {
  return bytes >= 4 ? value : value & ((1U << (8U * bytes)) - 1U);
}

// The short messages of CANopen (CiA 301): network management, heartbeat, SYNC, emergency. Node ids are 1 to 127.

enum class NmtCommand : std::uint8_t { kStart = 0x01, kStop = 0x02, kPreOperational = 0x80 };

enum class NmtState : std::uint8_t { kBootUp = 0x00, kStopped = 0x04, kOperational = 0x05, kPreOperational = 0x7F };

/// To one node, or to all with node 0.
[[nodiscard]] CanFrame nmt_frame(NmtCommand command, std::uint8_t node) noexcept;
[[nodiscard]] CanFrame sync_frame() noexcept;
/// What `node` says about itself once in its heartbeat time.
[[nodiscard]] CanFrame heartbeat_frame(std::uint8_t node, NmtState state) noexcept;

/// State in a heartbeat or boot-up message of `node`; nothing for another frame and for a state that does not exist.
[[nodiscard]] std::optional<NmtState> heartbeat_in(const CanFrame& frame, std::uint8_t node) noexcept;

/// Error code in an emergency message of `node`, 0: all errors are gone; nothing for another frame.
[[nodiscard]] std::optional<std::uint16_t> emergency_in(const CanFrame& frame, std::uint8_t node) noexcept;

/// The value for one entry of 1016h: `node` is missed after `time_ms`.
[[nodiscard]] constexpr std::uint32_t heartbeat_consumer_entry(std::uint8_t node, std::uint16_t time_ms) noexcept {
  return static_cast<std::uint32_t>(node) << 16U | time_ms;
}

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

/// Process data of receive PDO 1: controlword, and target velocity in counts/s.
[[nodiscard]] CanFrame command_frame(std::uint8_t node, std::uint16_t controlword, std::int32_t target) noexcept;

/// Process data that have drives quick-stop, which are set up as CanopenDriveBase does, and the SYNC with which they
/// take them.
[[nodiscard]] std::vector<CanFrame> quick_stop_frames(const std::array<std::uint8_t, 2>& nodes);

}  // namespace jaywalk::canopen
