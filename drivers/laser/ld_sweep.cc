#include "drivers/laser/ld_sweep.h"

namespace jaywalk::ldrobot {

bool SweepBuilder::add(const Packet& packet, Time arrival, LaserScan& scan) noexcept {
  if (packet.speed_degps == 0) return false;  // it does not turn: the points have no angle that could be believed
  const double first_deg = packet.first_angle_cdeg / 100.0;
  const double past_deg = (packet.last_angle_cdeg / 100.0) - first_deg;
  const double swept_deg = past_deg < 0.0 ? past_deg + 360.0 : past_deg;
  const double between_deg = swept_deg / (kPacketPoints - 1);
  bool completed = false;
  for (std::size_t k = 0; k < kPacketPoints; ++k) {
    const double turned_deg = between_deg * static_cast<double>(k);
    const double angle_deg = first_deg + turned_deg >= 360.0 ? first_deg + turned_deg - 360.0 : first_deg + turned_deg;
    const Time measured = arrival - duration_from_seconds((swept_deg - turned_deg) / packet.speed_degps);
    const float range_m = static_cast<float>(packet.points[k].range_mm) * 0.001F;
    completed = turn_.add(angle_deg, range_m, measured, scan) || completed;
  }
  return completed;
}

}  // namespace jaywalk::ldrobot
