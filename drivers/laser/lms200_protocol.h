#pragma once
#include <array>

#include "drivers/laser/lms200.h"
#include "drivers/laser/scanner_protocol.h"

namespace jaywalk::lms200 {

/// Makes an LMS200 send all its scans: quiet, then all values without end. Field of view, resolution, unit and line
/// rate are left as they were set in the scanner (9600 baud from the factory). It has no clock.
class Lms200Protocol final : public ScannerProtocol {
 public:
  /// `baud` is that of its endpoint.
  explicit Lms200Protocol(std::uint32_t baud) noexcept : baud_(baud) {}

  void begin() noexcept override;
  [[nodiscard]] wire::Bytes to_say(Time now) noexcept override;
  [[nodiscard]] bool awaits_answer() const noexcept override { return asked_; }
  void hear(wire::Bytes bytes) noexcept override { stream_.append(bytes); }
  [[nodiscard]] Heard next(Time arrival, LaserScan& scan) noexcept override;
  [[nodiscard]] ProtocolCounts counts() const noexcept override { return {0, stream_.skipped(), 0, warned_}; }

 private:
  std::uint32_t baud_;
  std::array<Command, 2> steps_{framed({0x20, 0x25}), framed({0x20, 0x24})};
  std::size_t at_ = 0;
  bool asked_ = false;
  TelegramStream stream_;
  std::uint64_t warned_ = 0;
};

}  // namespace jaywalk::lms200
