#pragma once
// What a client and the ARCOS board of a Pioneer tell each other: Pioneer 3 Operations Manual; the order of the
// settings is that of ARIA's reader.
#include <array>
#include <cstdint>
#include <optional>

#include "drivers/wire/byte_reader.h"

namespace jaywalk::arcos {

/// Numbers of commands. Before the connection is open 0, 1 and 2 are SYNC's, in this order.
enum class Command : std::uint8_t {
  kPulse = 0,
  kOpen = 1,
  kClose = 2,
  kEnable = 4,             ///< motors on (1), off (0)
  kAcceleration = 5,       ///< mm/s2; negative: deceleration
  kTop = 6,                ///< mm/s
  kTurnTop = 10,           ///< degrees/s
  kSpeed = 11,             ///< mm/s
  kSettings = 18,          ///< asks for them, once
  kEncoders = 19,          ///< 2: with every report
  kTurn = 21,              ///< degrees/s, counter-clockwise
  kTurnAcceleration = 23,  ///< degrees/s2; negative: deceleration
  kSonar = 28,             ///< on (1), off (0)
  kStop = 29,              ///< both speeds zero, by the ramps
  kEmergencyStop = 55      ///< the same, as fast as it can
};

struct Word {
  Command command = Command::kPulse;
  std::int16_t argument = 0;  ///< of those that take one
};

/// A word as it stands on the line.
struct Packet {
  std::array<std::uint8_t, 9> bytes{};
  std::size_t size = 0;
  [[nodiscard]] wire::Bytes on_line() const noexcept { return {bytes.data(), size}; }
};

[[nodiscard]] Packet packet_of(const Word& word) noexcept;
/// Sum of big-endian pairs; an odd last byte is exclusive-ored.
[[nodiscard]] std::uint16_t checksum(wire::Bytes body) noexcept;

/// Finds packets in a stream of bytes; what is damaged is skipped.
class PacketReader {
 public:
  void append(wire::Bytes bytes) noexcept { queue_.append(bytes); }
  /// The next packet's body, without header and checksum, until the next call; empty: none is whole.
  [[nodiscard]] wire::Bytes next() noexcept;

 private:
  wire::ByteQueue<1024> queue_;
  std::size_t told_ = 0;  ///< bytes of the packet that was returned last
};

/// Bits of Report::faults.
enum Fault : std::uint32_t { kLeftStall = 1, kRightStall = 0x100, kStopButton = 0x200000, kMotorStall = 0x400000 };

/// What it says each cycle.
struct Report {
  std::array<double, 2> speed_mmps{};  ///< left, right
  std::uint32_t faults = 0;
  bool motors_on = false;
};
/// Counts of both wheels' encoders, which wrap: left, right.
using Encoders = std::array<std::uint32_t, 2>;

struct Settings {
  std::array<char, 24> type{}, subtype{};  ///< ended by zero; longer ones are cut
  std::uint8_t cycle_ms = 0;               ///< between two reports
  std::uint16_t watchdog_ms = 0, ticks_per_mm = 0;
  std::uint16_t top_mmps = 0, turn_top_dps = 0;
  std::uint16_t acceleration_mmps2 = 0, deceleration_mmps2 = 0;
  std::uint16_t turn_acceleration_dps2 = 0, turn_deceleration_dps2 = 0;
};

/// Nothing where the body is of another kind, or too short.
[[nodiscard]] std::optional<Report> report_in(wire::Bytes body) noexcept;
[[nodiscard]] std::optional<Encoders> encoders_in(wire::Bytes body) noexcept;
[[nodiscard]] std::optional<Settings> settings_in(wire::Bytes body) noexcept;

}  // namespace jaywalk::arcos
