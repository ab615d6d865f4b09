#include "drivers/laser/ld_protocol.h"

namespace jaywalk::ldrobot {

void LdProtocol::begin() noexcept {
  stream_.forget();
  sweep_ = SweepBuilder();
  device_clock_.forget();
}

Heard LdProtocol::next(Time arrival, LaserScan& scan) noexcept {
  while (const auto packet = stream_.next()) {
    const Duration late = device_clock_.delay(packet->time_ms, arrival);
    if (sweep_.add(*packet, arrival - late, scan)) return Heard::kScan;
  }
  return Heard::kNothing;
}

}  // namespace jaywalk::ldrobot
