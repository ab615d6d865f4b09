#include "drivers/laser/ld_sweep.h"

#include <algorithm>

#include "hal/types/trig.h"

namespace jaywalk::ldrobot {

namespace {

constexpr double kSectorDeg = 360.0 / SweepBuilder::kBeams;
constexpr double kHalfTurnDeg = 180.0;  // a smaller step back is jitter between packets, not a new turn
constexpr float kRangeMin_m = 0.02F, kRangeMax_m = 12.0F;  // maker's data sheet

}  // namespace

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
    if (angle_deg < last_angle_deg_ - kHalfTurnDeg) {
      if (began_ != kNever) {
        close_turn(measured, scan);
        completed = true;
      }
      begin_turn(measured);
    }
    last_angle_deg_ = angle_deg;
    const float range_m = static_cast<float>(packet.points[k].range_mm) * 0.001F;
    const auto sector = std::min(static_cast<std::size_t>(angle_deg / kSectorDeg), std::size_t{kBeams - 1});
    float& nearest = nearest_m_[sector];
    if (range_m >= kRangeMin_m && (nearest == 0.0F || range_m < nearest)) nearest = range_m;
  }
  return completed;
}

void SweepBuilder::begin_turn(Time stamp) noexcept {
  nearest_m_.fill(0.0F);
  began_ = stamp;
}

void SweepBuilder::close_turn(Time end, LaserScan& scan) const noexcept {
  scan.stamp = began_;
  scan.beam_count = kBeams;
  scan.first_angle_rad = static_cast<float>(-0.5 * kSectorDeg * kPi / 180.0);  // a sector's middle
  scan.angle_step_rad = static_cast<float>(-kSectorDeg * kPi / 180.0);
  scan.range_min_m = kRangeMin_m;
  scan.range_max_m = kRangeMax_m;
  scan.sweep = std::max(end - began_, Duration{0});
  scan.period = scan.sweep;
  std::copy(nearest_m_.begin(), nearest_m_.end(), scan.range_m.begin());
}

}  // namespace jaywalk::ldrobot
