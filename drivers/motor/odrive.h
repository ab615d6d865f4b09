#pragma once
// ODrive's CANSimple messages (firmware 0.6): identifier node * 32 + command, floats least significant byte first.
#include <cstdint>
#include <optional>
#include <variant>

#include "drivers/can/can_frame.h"

namespace jaywalk::odrive {

enum class AxisState : std::uint8_t { kUndefined = 0, kIdle = 1, kClosedLoop = 8 };
/// As a heartbeat says it.
inline constexpr std::uint8_t kIdle = static_cast<std::uint8_t>(AxisState::kIdle);
inline constexpr std::uint8_t kClosedLoop = static_cast<std::uint8_t>(AxisState::kClosedLoop);

/// Bits of Heartbeat::active_errors that arming looks at; any other bit is an error too.
inline constexpr std::uint32_t kWatchdogExpired = 0x01000000, kEstopRequested = 0x02000000;

/// The watchdog's error in firmware 0.5 (AXIS_ERROR). That firmware sends the same messages but numbers its errors
/// otherwise.
inline constexpr std::uint32_t kWatchdogExpired05 = 0x00000800;

/// `node` is 0 to 62. A state: closed loop obeys speeds, idle lets go.
[[nodiscard]] CanFrame set_axis_state(std::uint8_t node, AxisState state) noexcept;
/// Velocity control; `ramped` limits its change by the axis' own setting.
[[nodiscard]] CanFrame set_velocity_mode(std::uint8_t node, bool ramped) noexcept;
/// Turns of the motor a second, forward positive. Every such frame feeds the watchdog.
[[nodiscard]] CanFrame set_velocity(std::uint8_t node, float turns_per_s) noexcept;
[[nodiscard]] CanFrame emergency_stop(std::uint8_t node) noexcept;
[[nodiscard]] CanFrame clear_errors(std::uint8_t node) noexcept;

struct Heartbeat {
  std::uint32_t active_errors = 0;
  std::uint8_t axis_state = 0;  ///< AxisState where it is one of those
  std::uint8_t procedure = 0;   ///< how the last change of state went: ProcedureResult
};

struct EncoderEstimates {
  float position_turns = 0.0F;  ///< finite
  float velocity_turns_per_s = 0.0F;
};

struct Errors {
  std::uint32_t active = 0;
  std::uint32_t disarm_reason = 0;
};

struct Message {
  std::uint8_t node = 0;
  std::variant<Heartbeat, EncoderEstimates, Errors> content;
};

/// Whether `frame` is one that only a controller sends to `node`: a command that sets something, or a request. Any of
/// them feeds the axis' watchdog.
[[nodiscard]] bool is_order(const CanFrame& frame, std::uint8_t node) noexcept;

/// Nothing where `frame` is none of these, is too short, or holds a number that is not finite.
[[nodiscard]] std::optional<Message> decode(const CanFrame& frame) noexcept;

}  // namespace jaywalk::odrive
