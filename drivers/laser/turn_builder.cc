#include "drivers/laser/turn_builder.h"

#include <algorithm>

#include "hal/types/trig.h"

namespace jaywalk {

namespace {

constexpr double kHalfTurnDeg = 180.0;  // a smaller step back is jitter, not a new turn

}  // namespace

bool TurnBuilder::add(double angle_deg, float range_m, Time measured, LaserScan& scan) noexcept {
  bool completed = false;
  if (angle_deg < last_angle_deg_ - kHalfTurnDeg) {
    completed = began_ != kNever;
    if (completed) close_turn(measured, scan);
    nearest_m_.fill(0.0F);
    began_ = measured;
  }
  last_angle_deg_ = angle_deg;
  const double sector_deg = 360.0 / sectors_;
  const auto sector = std::min(static_cast<std::size_t>(angle_deg / sector_deg), std::size_t{sectors_ - 1});
  float& nearest = nearest_m_[sector];
  if (range_m >= range_min_m_ && (nearest == 0.0F || range_m < nearest)) nearest = range_m;
  return completed;
}

void TurnBuilder::close_turn(Time end, LaserScan& scan) const noexcept {
  const double sector_rad = 2.0 * kPi / sectors_;
  scan.stamp = began_;
  scan.beam_count = sectors_;
  scan.first_angle_rad = static_cast<float>(-0.5 * sector_rad);  // a sector's middle
  scan.angle_step_rad = static_cast<float>(-sector_rad);
  scan.range_min_m = range_min_m_;
  scan.range_max_m = range_max_m_;
  scan.sweep = std::max(end - began_, Duration{0});
  scan.period = scan.sweep;
  std::copy_n(nearest_m_.begin(), sectors_, scan.range_m.begin());
}

}  // namespace jaywalk
