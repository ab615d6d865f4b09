#include "firmware/safety/wheel_travel.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

constexpr Duration kMostBeyond = std::chrono::milliseconds(200);

Rolled between(const Rolled& a, const Rolled& b, double share) noexcept {
  return {a.left_m + share * (b.left_m - a.left_m), a.right_m + share * (b.right_m - a.right_m)};
}

}  // namespace

void WheelTravel::note(const WheelState& wheels) noexcept {
  if (wheels.sequence == seen_ || wheels.sequence == 0) return;
  seen_ = wheels.sequence;
  if (!std::isfinite(wheels.left_rad) || !std::isfinite(wheels.right_rad)) return;
  if (readings_[newest_].stamp >= wheels.stamp) return;
  newest_ = (newest_ + 1) % kMostReadings;
  readings_[newest_] = {wheels.stamp,
                        {drive_.wheel_radius_m * wheels.left_rad, drive_.wheel_radius_m * wheels.right_rad}};
}

bool WheelTravel::at(Time stamp, Rolled& rolled) const noexcept {
  const Reading* after = &readings_[newest_];
  if (after->stamp < stamp) return false;
  for (std::size_t back = 1; back < kMostReadings; ++back) {
    const Reading& before = readings_[(newest_ + kMostReadings - back) % kMostReadings];
    if (before.stamp == kNever || before.stamp > after->stamp) return false;
    if (before.stamp <= stamp) {
      rolled = between(before.rolled, after->rolled,
                       to_seconds(stamp - before.stamp) / to_seconds(after->stamp - before.stamp));
      return true;
    }
    after = &before;
  }
  return false;
}

bool WheelTravel::expected_at(Time stamp, Rolled& rolled) const noexcept {
  const Reading& last = readings_[newest_];
  const Reading& before = readings_[(newest_ + kMostReadings - 1) % kMostReadings];
  if (last.stamp == kNever) return false;
  if (stamp < last.stamp) return at(stamp, rolled);
  const bool extrapolates = before.stamp != kNever && stamp - last.stamp <= kMostBeyond;
  const double share = extrapolates ? to_seconds(stamp - before.stamp) / to_seconds(last.stamp - before.stamp) : 1.0;
  rolled = between(before.rolled, last.rolled, share);
  return true;
}

Twist2 WheelTravel::twist_since(Time stamp, const Rolled& rolled) const noexcept {
  constexpr double kLeast_s = 0.005;
  const Reading& now = readings_[newest_];
  const double seconds = to_seconds(now.stamp - stamp);
  if (seconds < kLeast_s) return {};
  const double left = (now.rolled.left_m - rolled.left_m) / seconds,
               right = (now.rolled.right_m - rolled.right_m) / seconds;
  return {0.5 * (left + right), (right - left) / drive_.track_width_m};
}

Pose2 arc_of(const Rolled& rolled, double track_width_m) noexcept {
  const double turn = (rolled.right_m - rolled.left_m) / track_width_m;
  const Vec2 way = direction(0.5 * turn) * (0.5 * (rolled.left_m + rolled.right_m));
  return {way.x, way.y, turn};
}

}  // namespace jaywalk
