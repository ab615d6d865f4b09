#include "firmware/safety/frozen_scan.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace jaywalk {
namespace {

constexpr int kAlike = 3;
constexpr double kRolledM = 0.1;

/// FNV-1a (Fowler, Noll and Vo 1991), a range at a time.
std::uint64_t digest_of(const LaserScan& scan) {
  std::uint64_t digest = 14695981039346656037ULL;
  bool hits = false;
  const std::size_t beams = std::min<std::size_t>(scan.beam_count, kMaxBeams);
  for (std::size_t beam = 0; beam < beams; ++beam) {
    hits = hits || scan.is_hit(beam);
    digest = (digest ^ std::bit_cast<std::uint32_t>(scan.range_m[beam])) * 1099511628211ULL;
  }
  return hits ? digest : 0;
}

}  // namespace

bool FrozenScan::is_frozen(const LaserScan& scan, const WheelState& wheels) noexcept {
  if (scan.sequence != scan_seen_) {
    scan_seen_ = scan.sequence;
    const std::uint64_t digest = digest_of(scan);
    const bool alike = digest != 0 && digest == digest_ && at_first_.sequence != 0;
    alike_ = alike ? std::min(alike_ + 1, kAlike) : 1;
    if (!alike) at_first_ = wheels;
    digest_ = digest;
  }
  const double rolled_rad =
      std::max(std::fabs(wheels.left_rad - at_first_.left_rad), std::fabs(wheels.right_rad - at_first_.right_rad));
  return alike_ >= kAlike && rolled_rad * drive_.wheel_radius_m > kRolledM;
}

}  // namespace jaywalk
