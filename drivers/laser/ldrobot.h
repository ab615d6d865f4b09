#pragma once
// LDROBOT LD06 and LD19: packets of twelve points on a serial line, 230400 baud, one way.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "drivers/laser/scanner_protocol.h"
#include "drivers/wire/byte_reader.h"

namespace jaywalk::ldrobot {

inline constexpr std::size_t kPacketBytes = 47, kPacketPoints = 12;

struct Packet {
  std::uint16_t speed_degps = 0;
  std::uint16_t first_angle_cdeg = 0;  ///< hundredths of a degree, clockwise from ahead, below 36000
  std::uint16_t last_angle_cdeg = 0;
  std::uint16_t time_ms = 0;                            ///< the scanner's clock; wraps at 30000
  std::array<std::uint16_t, kPacketPoints> range_mm{};  ///< 0: nothing measured, for whatever cause
};

/// CRC-8 with polynomial 4Dh, from 0, highest bit first.
[[nodiscard]] std::uint8_t crc8(wire::Bytes bytes) noexcept;

/// Nothing unless `bytes` is one packet: kPacketBytes that begin with 54h 2Ch, with its checksum and sane angles.
[[nodiscard]] std::optional<Packet> decode_packet(wire::Bytes bytes) noexcept;

/// Finds packets in a stream; after garbage it goes on at the next one whose checksum holds.
struct PacketStream : wire::ByteQueue<4096> {
  /// Nothing until more bytes came.
  [[nodiscard]] std::optional<Packet> next() noexcept;
};

/// Makes scans of packets.
class SweepBuilder {
 public:
  static constexpr std::uint32_t kBeams = 450;  ///< 0.8 degrees: 4500 points a second at 10 turns a second

  /// Adds a packet whose last byte came in at `arrival`; true when it completed a turn, then `scan` holds it, all but
  /// its sequence. Otherwise `scan` is left alone.
  [[nodiscard]] bool add(const Packet& packet, Time arrival, LaserScan& scan) noexcept;

 private:
  TurnBuilder turn_{kBeams, 0.02F, 12.0F};  ///< ranges: maker's data sheet
};

/// An LD06 or LD19 on a serial line of 230400 baud: it sends from when it has power, and nothing is said to it.
class LdProtocol final : public ScannerProtocol {
 public:
  void begin() noexcept override;
  void hear(wire::Bytes bytes) noexcept override { stream_.append(bytes); }
  [[nodiscard]] Heard next(Time arrival, LaserScan& scan) noexcept override;
  /// Packets are not numbered: what is lost of them shows as skipped bytes, and as unknown beams.
  [[nodiscard]] ProtocolCounts counts() const noexcept override { return {0, stream_.skipped(), 0, 0}; }

 private:
  PacketStream stream_;
  SweepBuilder sweep_;
  DeviceClock device_clock_{std::chrono::milliseconds(1), 30000};
};

}  // namespace jaywalk::ldrobot
