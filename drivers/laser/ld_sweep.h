#pragma once
#include "drivers/laser/ld_packet.h"
#include "drivers/laser/turn_builder.h"

namespace jaywalk::ldrobot {

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

}  // namespace jaywalk::ldrobot
