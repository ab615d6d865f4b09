#pragma once
#include "drivers/laser/ld_packet.h"
#include "hal/types/laser_scan.h"

namespace jaywalk::ldrobot {

/// Makes scans of packets: a turn begins where the angle passes straight ahead.
///
/// The scanner turns clockwise and its points lie at uneven angles; they are put into kBeams equal sectors, the
/// nearest point of a sector counts (as is right for what must not be hit), and sectors without a point hold 0, "no
/// return". The first turn, seen in part, is not handed out.
class SweepBuilder {
 public:
  static constexpr std::uint32_t kBeams = 450;  ///< 0.8 degrees: 4500 points a second at 10 turns a second

  /// Adds a packet whose last byte came in at `arrival`; true when it completed a turn, then `scan` holds it, all but
  /// its sequence. Otherwise `scan` is left alone.
  [[nodiscard]] bool add(const Packet& packet, Time arrival, LaserScan& scan) noexcept;

 private:
  void begin_turn(Time stamp) noexcept;
  void close_turn(Time end, LaserScan& scan) const noexcept;

  std::array<float, kBeams> nearest_m_{};
  Time began_ = kNever;
  double last_angle_deg_ = 0.0;
};

}  // namespace jaywalk::ldrobot
