#pragma once
// LDROBOT LD06 and LD19: packets of twelve points on a serial line, 230400 baud, one way.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "drivers/laser/decoding.h"
#include "drivers/wire/byte_queue.h"

namespace jaywalk::ldrobot {

inline constexpr std::size_t kPacketBytes = 47, kPacketPoints = 12;

struct Point {
  std::uint16_t range_mm = 0;  ///< 0: nothing measured, for whatever cause
  std::uint8_t intensity = 0;
};

struct Packet {
  std::uint16_t speed_degps = 0;
  std::uint16_t first_angle_cdeg = 0;  ///< hundredths of a degree, clockwise from ahead, below 36000
  std::uint16_t last_angle_cdeg = 0;
  std::uint16_t time_ms = 0;  ///< the scanner's clock; wraps at 30000
  std::array<Point, kPacketPoints> points{};
};

/// CRC-8 with polynomial 4Dh, from 0, highest bit first.
[[nodiscard]] std::uint8_t crc8(wire::Bytes bytes) noexcept;

/// `bytes` is one packet: kPacketBytes that begin with 54h 2Ch.
[[nodiscard]] Decoding decode_packet(wire::Bytes bytes, Packet& packet) noexcept;

/// Finds packets in a stream; after garbage it goes on at the next one whose checksum holds.
class PacketStream {
 public:
  void append(wire::Bytes bytes) noexcept { queue_.append(bytes); }
  /// Drops what waits, uncounted: another connection begins.
  void forget() noexcept { queue_.clear(); }
  /// Nothing until more bytes came.
  [[nodiscard]] std::optional<Packet> next() noexcept;
  /// Bytes that belonged to no packet.
  [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_ + queue_.lost(); }

 private:
  wire::ByteQueue<4096> queue_;
  std::uint64_t skipped_ = 0;
};

}  // namespace jaywalk::ldrobot
