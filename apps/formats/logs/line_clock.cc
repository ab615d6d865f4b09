#include "apps/formats/logs/line_clock.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace jaywalk::sim {
namespace {

constexpr double kDrivesM = 0.02, kDrivesRad = 0.02;  // more than a standing robot's wheels make up
// No laser turns faster than the one; recorded ones turn ten times a second more often than not.
constexpr Duration kShortestStep = std::chrono::milliseconds(1), kOtherwise = std::chrono::milliseconds(100);

bool drives(const Pose2& moved) { return norm(moved.position()) > kDrivesM || std::fabs(moved.heading) > kDrivesRad; }

}  // namespace

void LineClock::see(Time said, const Pose2& moved) noexcept {
  if (lines_++ == 0)
    first_ = last_ = said;
  else if (said <= last_ && drives(moved))
    ++stood_;
  last_ = std::max(last_, said);
}

Time LineClock::even(std::size_t k) const {
  const auto steps = static_cast<Duration::rep>(std::max<std::size_t>(lines_, 2) - 1);
  const auto at = static_cast<Duration::rep>(k);
  const Duration span = last_ - first_;
  return span / steps >= kShortestStep ? first_ + Duration{span.count() / steps * at} : first_ + kOtherwise * at;
}

}  // namespace jaywalk::sim
