#pragma once
// SICK LMS200 on a serial line: STX, address, length, body, CRC-16; numbers least significant byte first.
#include <cstddef>
#include <cstdint>
#include <optional>

#include "drivers/laser/scanner_protocol.h"
#include "drivers/wire/byte_reader.h"
#include "hal/types/laser_scan.h"

namespace jaywalk::lms200 {

/// The maker's own CRC: each byte goes in together with the one before it; generator 8005h.
[[nodiscard]] std::uint16_t crc16(wire::Bytes bytes) noexcept;

/// Cuts a stream into the bodies of telegrams from scanner 0; after garbage it goes on at the next whose checksum
/// holds. An ACK is not counted as skipped.
struct TelegramStream : wire::ByteQueue<4096> {
  /// Command, fields and the scanner's status byte; valid until the next append.
  [[nodiscard]] std::optional<wire::Bytes> next() noexcept;
};

/// Decodes a telegram B0h, all measured values, into `scan`, all but its sequence.
///
/// `baud` is the line's rate: the scan's stamp is `arrival` less what the telegram took on the line, less the sweep.
/// Half and quarter degrees are measured in two and four turns of the mirror, interlaced; the sweep spans them all. The
/// three highest bits of a value are flags: field A, field B, dazzled (the measuring mode of the factory). The rest is
/// a distance up to 8182 counts of a centimetre or a millimetre, 8183 for one beyond that, or an error code above. A
/// dazzled value and an error code prove nothing.
[[nodiscard]] Heard decode_scan(wire::Bytes body, std::uint32_t baud, Time arrival, LaserScan& scan) noexcept;

/// Makes an LMS200 send all its scans: quiet, then all values without end. Field of view, resolution, unit and line
/// rate are left as they were set in the scanner (9600 baud from the factory). It has no clock.
class Lms200Protocol final : public ScannerProtocol {
 public:
  /// `baud` is that of its endpoint.
  explicit Lms200Protocol(std::uint32_t baud) noexcept : baud_(baud) {}

  void begin() noexcept override;
  [[nodiscard]] wire::Bytes to_say(Time now) noexcept override;
  void hear(wire::Bytes bytes) noexcept override { stream_.append(bytes); }
  [[nodiscard]] Heard next(Time arrival, LaserScan& scan) noexcept override;
  [[nodiscard]] ProtocolCounts counts() const noexcept override { return {0, stream_.skipped(), 0, warned_}; }

 private:
  std::uint32_t baud_;
  std::size_t at_ = 0;  ///< index of the set-up command to send next, or whose answer is pending
  TelegramStream stream_;
  std::uint64_t warned_ = 0;
};

}  // namespace jaywalk::lms200
