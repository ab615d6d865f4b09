#pragma once
#include "drivers/canopen/arming_proof.h"

namespace jaywalk::canopen {

/// What one drive is to be told before it may move.
struct DriveSettings {
  std::uint8_t controller_node = 1;           ///< whose heartbeat it watches
  std::uint16_t controller_timeout_ms = 100;  ///< then it stops by itself
  std::uint16_t heartbeat_ms = 50;            ///< its own
  std::uint32_t acceleration = 0;             ///< 6083h, counts/s2
  std::uint32_t deceleration = 0;             ///< 6084h, counts/s2
  std::uint32_t quick_stop = 0;               ///< 6085h, counts/s2
  std::uint32_t standstill = 0;               ///< a wheel that says no more than this (counts/s) stands
};

/// Receive PDO 1 of `node`: controlword and target velocity.
[[nodiscard]] PdoSetup command_pdo(std::uint8_t node) noexcept;
/// Transmit PDO 1: statusword, velocity and the mode shown. Both PDOs go at every SYNC.
[[nodiscard]] PdoSetup status_pdo(std::uint8_t node) noexcept;
/// Transmit PDO 2: position.
[[nodiscard]] PdoSetup position_pdo(std::uint8_t node) noexcept;

/// How the drive is to behave: heartbeats, what happens when they fail, ramps, mode.
[[nodiscard]] ArmingProof::Items behaviour_items(const DriveSettings& settings) noexcept;
/// These, and the PDOs, which are switched off, mapped and switched on.
[[nodiscard]] ArmingProof::Items proof_items(std::uint8_t node, const DriveSettings& settings) noexcept;

/// All that a drive must show before it may turn a wheel: these, that it stands, and its identity (1018h), by which
/// another drive with the same number is told when it is proved again.
[[nodiscard]] ArmingProof::Items whole_proof(std::uint8_t node, const DriveSettings& settings) noexcept;

/// What tells a CiA 402 drive: its device type (1000h), and its modes (6502h), to be read alone.
[[nodiscard]] ArmingProof::Items identity_items() noexcept;
/// Of the answers to these.
[[nodiscard]] bool speaks_profile_velocity(const ArmingProof::Lines& identity) noexcept;

}  // namespace jaywalk::canopen
