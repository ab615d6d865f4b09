#pragma once
#include "drivers/laser/device_clock.h"
#include "drivers/laser/ld_sweep.h"
#include "drivers/laser/scanner_protocol.h"

namespace jaywalk::ldrobot {

/// An LD06 or LD19 on a serial line of 230400 baud: it sends from when it has power, and nothing is said to it.
class LdProtocol final : public ScannerProtocol {
 public:
  void begin() noexcept override;
  [[nodiscard]] wire::Bytes to_say(Time) noexcept override { return {}; }
  [[nodiscard]] bool awaits_answer() const noexcept override { return false; }
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
