#pragma once
// Scanners on serial lines: LDROBOT, SICK LMS200, RPLIDAR.
#include <optional>

#include "drivers/laser/scanner_protocol.h"

/// LDROBOT LD06 and LD19: packets of twelve points, 230400 baud, one way.
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

/// SICK LMS200: STX, address, length, body, CRC-16; numbers least significant byte first.
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

/// Slamtec's RPLIDAR A series: requests A5h and a command, answers A5h 5Ah and their length and type.
namespace jaywalk::rplidar {

/// One measured point.
struct Node {
  double angle_deg = 0.0;  ///< clockwise from ahead, below 360
  float range_m = 0.0F;    ///< 0: the measurement is not valid
};

/// Nothing where the bytes are fewer, their check bits wrong, or the angle more than a turn and 10 degrees.
[[nodiscard]] std::optional<Node> decode_node(wire::Bytes bytes) noexcept;

/// An RPLIDAR A1, A2 or A3 on a serial line (115200 or 256000 baud): stop, motor on, ask how it is, scan. It has no
/// clock and no checksum; points are stamped when they come in, and a turn is handed out as 360 sectors of a degree.
class RplidarProtocol final : public ScannerProtocol {
 public:
  void begin() noexcept override;
  [[nodiscard]] wire::Bytes to_say(Time now) noexcept override;
  [[nodiscard]] bool awaits_answer() const noexcept override { return step_ == Step::kHealth || step_ == Step::kScan; }
  void hear(wire::Bytes bytes) noexcept override { queue_.append(bytes); }
  [[nodiscard]] Heard next(Time arrival, LaserScan& scan) noexcept override;
  [[nodiscard]] ProtocolCounts counts() const noexcept override { return {0, queue_.skipped(), 0, warned_}; }

 private:
  enum class Step : std::uint8_t { kStop, kPause, kHealth, kAskScan, kScan, kNodes };

  [[nodiscard]] bool find(wire::Bytes descriptor) noexcept;
  [[nodiscard]] Heard on_health() noexcept;
  [[nodiscard]] Heard on_nodes(Time arrival, LaserScan& scan) noexcept;
  [[nodiscard]] bool in_step() const noexcept;

  Step step_ = Step::kStop;
  Time stopped_ = kNever;
  bool answer_found_ = false;
  bool lost_step_ = true;  ///< where a node begins is not known
  wire::ByteQueue<8192> queue_;
  TurnBuilder turn_{360, 0.15F, 25.0F};  ///< A1 to A3: nothing below, 12 to 25 m at most (maker's data sheets)
  std::uint64_t warned_ = 0;
};

}  // namespace jaywalk::rplidar
