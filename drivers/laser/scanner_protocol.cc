#include "drivers/laser/scanner_protocol.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hal/types/trig.h"

namespace jaywalk {
namespace {

constexpr double kHalfTurnDeg = 180.0;  // a smaller step back is jitter, not a new turn
/// A longer step than so many sectors, from a point to the next, means that points between them are missing.
constexpr double kUsualStep = 1.5;

}  // namespace

bool TurnBuilder::add(double angle_deg, float range_m, Time measured, LaserScan& scan) noexcept {
  bool completed = false;
  if (angle_deg < last_angle_deg_ - kHalfTurnDeg) {
    completed = began_ != kNever;
    if (completed) close_turn(measured, scan);
    sector_m_.fill(0.0F);
    began_ = measured;
  }
  const double sector_deg = 360.0 / sectors_;
  const bool as_usual = angle_deg - last_angle_deg_ < kUsualStep * sector_deg;
  last_angle_deg_ = angle_deg;
  const auto sector = std::min(static_cast<std::size_t>(angle_deg / sector_deg), std::size_t{sectors_ - 1});
  if (as_usual) fill_stepped_over(sector, range_m);
  put(range_m, sector_m_[sector]);
  last_sector_ = sector;
  last_range_m_ = range_m;
  return completed;
}

void TurnBuilder::fill_stepped_over(std::size_t sector, float range_m) noexcept {
  const bool measured = range_m >= range_min_m_ && last_range_m_ >= range_min_m_;
  if (sector != last_sector_ + 2 || sector_m_[sector - 1] != 0.0F || !measured) return;
  put(std::min(range_m, last_range_m_), sector_m_[sector - 1]);
}

void TurnBuilder::put(float range_m, float& sector) const noexcept {
  const auto is_hit = [this](float r) { return r >= range_min_m_ && r < range_max_m_; };
  if (is_hit(range_m)) {
    sector = is_hit(sector) ? std::min(sector, range_m) : range_m;
  } else if (!is_hit(sector)) {
    const bool free = range_m >= range_max_m_ && !std::isnan(sector);
    sector = free ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
  }
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
  std::transform(sector_m_.begin(), sector_m_.begin() + sectors_, scan.range_m.begin(),
                 [](float m) { return std::isnan(m) ? 0.0F : m; });
}

}  // namespace jaywalk
