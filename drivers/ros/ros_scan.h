#pragma once
#include "drivers/laser/scanner_protocol.h"
#include "drivers/ros/shared_ring.h"
#include "drivers/wire/byte_link.h"

namespace jaywalk::ros {

/// Fills `scan`, all but its sequence, from a message that came in by `arrival`. Nothing in it is believed: kMalformed
/// for another size, angles, limits or times that no scanner has. An infinite range is free where `infinity_is_free`
/// (REP 117), else unknown, as all that is no number or not above zero.
[[nodiscard]] Heard decode_scan(wire::Bytes message, Time arrival, bool infinity_is_free, LaserScan& scan) noexcept;

/// Scans of a ROS topic: nothing is said, each message is whole.
class RosScanProtocol final : public ScannerProtocol {
 public:
  explicit RosScanProtocol(bool infinity_is_free) noexcept : infinity_is_free_(infinity_is_free) {}
  void begin() noexcept override { heard_ = 0; }
  void hear(wire::Bytes bytes) noexcept override;
  [[nodiscard]] Heard next(Time arrival, LaserScan& scan) noexcept override;
  [[nodiscard]] ProtocolCounts counts() const noexcept override { return {}; }

 private:
  bool infinity_is_free_;
  std::size_t heard_ = 0;  ///< bytes of the message; 0: none
  std::array<std::uint8_t, kScanRing.message_bytes> message_{};
};

/// The scans that jaywalk_dds puts into a shared ring, as a link that brings one whole message at a time; a torn one is
/// a single byte. It is open at once: scans that do not come are a silent scanner.
class RingLink final : public wire::Link {
 public:
  /// Makes the ring. `name`: the topic. Throws StartupError.
  RingLink(const std::filesystem::path& ring, std::string name)
      : ring_(SharedRing::make(ring, kScanRing)), name_(std::move(name)) {}

  [[nodiscard]] const std::string& name() const noexcept override { return name_; }
  void open() noexcept override;
  void close() noexcept override { state_ = State::kClosed; }
  [[nodiscard]] State state() noexcept override { return state_; }
  [[nodiscard]] wire::Bytes read(std::span<std::uint8_t> room) noexcept override;
  void write(wire::Bytes) noexcept override {}
  void wait(Duration most) noexcept override;

 private:
  std::unique_ptr<SharedRing> ring_;
  std::string name_;
  State state_ = State::kClosed;
  std::array<std::uint8_t, kScanRing.message_bytes> message_{};
};

}  // namespace jaywalk::ros
