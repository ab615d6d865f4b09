#pragma once
// The short messages of CANopen (CiA 301): network management, heartbeat, SYNC, emergency. Node ids are 1 to 127.
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/can/can_frame.h"

namespace jaywalk::canopen {

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
  std::uint16_t error_code = 0;               ///< 0: the device reports that all errors are gone
  std::uint8_t error_register = 0;            ///< object 1001h
  std::array<std::uint8_t, 5> maker_bytes{};  ///< the maker's own
};

[[nodiscard]] CanFrame emergency_frame(const Emergency& emergency) noexcept;
/// Nothing where `frame` is no emergency message (a SYNC has the same function code and node 0).
[[nodiscard]] std::optional<Emergency> decode_emergency(const CanFrame& frame) noexcept;
/// The class of an emergency's error code (CiA 301): "current", "voltage", ...
[[nodiscard]] std::string_view emergency_class(std::uint16_t error_code) noexcept;

/// The value for one entry of 1016h: `node` is missed after `time_ms`.
[[nodiscard]] constexpr std::uint32_t heartbeat_consumer_entry(std::uint8_t node, std::uint16_t time_ms) noexcept {
  return static_cast<std::uint32_t>(node) << 16U | time_ms;
}

}  // namespace jaywalk::canopen
