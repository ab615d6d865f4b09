#pragma once
// The state machine of a drive (CiA 402, IEC 61800-7-201): what the statusword says, what the controlword asks.
// Process data: objects packed into a frame, and the writes that make a drive do so (CiA 301).
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/can/can_bus.h"
#include "hal/types/fixed_vector.h"

namespace jaywalk::canopen {

/// Where a value lives in a device's object dictionary.
struct ObjectAddress {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  bool operator==(const ObjectAddress&) const = default;
  constexpr bool operator<(const ObjectAddress& other) const {
    return index != other.index ? index < other.index : sub < other.sub;
  }
};

/// One object inside a PDO; whole bytes only, 1 to 4 of them.
struct MappedObject {
  ObjectAddress address;
  std::uint8_t bytes = 0;

  /// As it stands in 1600h and 1A00h: index, sub-index, length in bits.
  [[nodiscard]] constexpr std::uint32_t mapping_word() const noexcept {
    return static_cast<std::uint32_t>(address.index) << 16U | static_cast<std::uint32_t>(address.sub) << 8U |
           static_cast<std::uint32_t>(bytes) * 8U;
  }
};

using PdoMapping = FixedVector<MappedObject, 8>;

/// Bytes that the mapping fills; a PDO has at most 8.
[[nodiscard]] std::size_t length_of(const PdoMapping& mapping) noexcept;

/// Packs one value an object (two's complement, cut to its bytes) under `id`. Nothing where counts or lengths do not
/// fit. A frame's unused bytes are 0.
[[nodiscard]] std::optional<CanFrame> pack(const PdoMapping& mapping, std::uint32_t id,
                                           std::span<const std::uint32_t> values) noexcept;

/// The values of a frame, each with zeros above its bytes. Nothing where the frame is shorter than the mapping; a
/// longer one is taken, as CiA 301 has it.
[[nodiscard]] std::optional<FixedVector<std::uint32_t, 8>> unpack(const PdoMapping& mapping,
                                                                  const CanFrame& frame) noexcept;

/// One write to a drive's object dictionary, of 1, 2 or 4 bytes.
struct ObjectWrite {
  ObjectAddress address;
  std::uint32_t value = 0;
  std::uint8_t bytes = 0;
  bool operator==(const ObjectWrite&) const = default;
};

using ObjectWrites = FixedVector<ObjectWrite, 64>;

/// Where a PDO's settings live: receive PDO n at 1400h + n - 1 and 1600h + n - 1, transmit at 1800h and 1A00h.
struct PdoSetup {
  std::uint16_t communication_index = 0;
  std::uint16_t mapping_index = 0;
  std::uint32_t id = 0;                ///< COB-ID, 11 bits
  std::uint8_t transmission_type = 0;  ///< 1: with every SYNC; 255: at once
  PdoMapping mapping;
};

/// Appends the writes that switch the PDO off, map it anew and switch it on. False where they do not fit.
[[nodiscard]] bool append_setup(const PdoSetup& setup, ObjectWrites& writes) noexcept;

// The short messages of CANopen (CiA 301): network management, heartbeat, SYNC, emergency. Node ids are 1 to 127.

enum class NmtCommand : std::uint8_t {
  kStart = 0x01,
  kStop = 0x02,
  kPreOperational = 0x80,
  kResetNode = 0x81,
  kResetCommunication = 0x82
};

enum class NmtState : std::uint8_t { kBootUp = 0x00, kStopped = 0x04, kOperational = 0x05, kPreOperational = 0x7F };

/// To one node, or to all with node 0.
[[nodiscard]] CanFrame nmt_frame(NmtCommand command, std::uint8_t node) noexcept;
[[nodiscard]] CanFrame sync_frame() noexcept;
/// What `node` says about itself once in its heartbeat time.
[[nodiscard]] CanFrame heartbeat_frame(std::uint8_t node, NmtState state) noexcept;

struct Heartbeat {
  std::uint8_t node = 0;
  NmtState state = NmtState::kBootUp;
};

/// Nothing where `frame` is no heartbeat or boot-up message, or names a state that does not exist.
[[nodiscard]] std::optional<Heartbeat> decode_heartbeat(const CanFrame& frame) noexcept;

struct Emergency {
  std::uint8_t node = 0;
  std::uint16_t error_code = 0;  ///< 0: the device reports that all errors are gone
};

/// Nothing where `frame` is no emergency message (a SYNC has the same function code and node 0).
[[nodiscard]] std::optional<Emergency> decode_emergency(const CanFrame& frame) noexcept;
/// The class of an emergency's error code (CiA 301): "current", "voltage", ...
[[nodiscard]] std::string_view emergency_class(std::uint16_t error_code) noexcept;

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

/// Process data that have drives quick-stop, which are set up as CanopenDriveBase does, and the SYNC with which they
/// take them.
[[nodiscard]] std::vector<CanFrame> quick_stop_frames(const std::array<std::uint8_t, 2>& nodes);

}  // namespace jaywalk::canopen
