#include "hal/types/blanking.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hal/types/geometry.h"

namespace jaywalk {
namespace {

constexpr double kSame_rad = 1e-6;  // single precision's angles: a beam on a sector's rim is in it

/// Counter-clockwise from one direction to the other, in [0, 2 pi).
double turn_between(double from_rad, double to_rad) {
  const double turn = wrap_angle(to_rad - from_rad);
  return turn < 0.0 ? turn + 2.0 * kPi : turn;
}

}  // namespace

double BlankedSector::width_rad() const noexcept { return turn_between(from_rad, to_rad); }

double BlankedSector::off_rad(double direction_rad) const noexcept {
  const double past_from = turn_between(from_rad, direction_rad), width = width_rad();
  if (past_from <= width) return 0.0;
  return std::min(past_from - width, 2.0 * kPi - past_from);
}

void blank(const Blanking& sectors, LaserScan& scan) noexcept {
  if (sectors.empty()) return;
  const std::size_t beams = std::min<std::size_t>(scan.beam_count, kMaxBeams);
  for (std::size_t k = 0; k < beams; ++k) {
    const double angle = scan.angle_rad(k);
    const bool own = std::any_of(sectors.begin(), sectors.end(),
                                 [&](const BlankedSector& sector) { return sector.off_rad(angle) <= kSame_rad; });
    if (own) scan.range_m[k] = -std::numeric_limits<float>::infinity();
  }
}

}  // namespace jaywalk
