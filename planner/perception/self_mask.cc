#include "planner/perception/self_mask.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

constexpr double kTurnRad = 0.1;
constexpr float kFarthestM = 1.0F;
constexpr float kSameM = 0.03F;  // a laser's noise at this distance, twice
constexpr int kMost = 20;        // headings remembered: what was taken off is forgotten after as many

}  // namespace

void SelfMask::learn(const LaserScan& scan, double heading) noexcept {
  if (std::fabs(wrap_angle(heading - asked_at_rad_)) < kTurnRad) return;
  asked_at_rad_ = heading;
  const std::size_t beams = std::min<std::size_t>(scan.beam_count, kMaxBeams);
  for (std::size_t b = 0; b < beams; ++b) {
    if (!scan.is_hit(b)) continue;  // proves nothing
    const float range = scan.range_m[b];
    const bool same = range < kFarthestM && std::fabs(range - range_m_[b]) < kSameM;
    if (same) {
      agreed_[b] = static_cast<std::uint8_t>(std::min(agreed_[b] + 1, kMost));
    } else if (agreed_[b] > 0) {
      --agreed_[b];  // a mast sways; the robot does not lose it
    } else {
      range_m_[b] = range;
    }
  }
}

}  // namespace jaywalk
