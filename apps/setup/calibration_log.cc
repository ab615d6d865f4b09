#include "apps/setup/calibration_log.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

constexpr Duration kLongestGap = std::chrono::milliseconds(250);  ///< between readings: what was between is not known

WheelTurns between_two(const WheelTurns& a, const WheelTurns& b, Time stamp) {
  const double span = to_seconds(b.stamp - a.stamp), share = span > 0.0 ? to_seconds(stamp - a.stamp) / span : 0.0;
  return {stamp, a.left_rad + share * (b.left_rad - a.left_rad), a.right_rad + share * (b.right_rad - a.right_rad)};
}

}  // namespace

bool CalibrationLog::is_far_from_last() const {
  if (scans_.empty()) return true;
  const double left_m = (wheels_.back().left_rad - at_last_scan_.left_rad) * drive_.wheel_radius_m,
               right_m = (wheels_.back().right_rad - at_last_scan_.right_rad) * drive_.wheel_radius_m;
  return std::fabs(left_m + right_m) > 2.0 * kApart_m ||
         std::fabs(right_m - left_m) > kApart_rad * drive_.track_width_m;
}

void CalibrationLog::take(const WheelState& wheels, const LaserScan& scan) {
  if (wheels.sequence != wheel_sequence_) {
    wheel_sequence_ = wheels.sequence;
    wheels_.push_back({wheels.stamp, wheels.left_rad, wheels.right_rad});
  }
  if (scan.sequence == scan_sequence_ || wheels_.empty()) return;
  scan_sequence_ = scan.sequence;
  if (scan.stamp < wheels_.front().stamp || scans_.size() >= kMostScans || !is_far_from_last()) return;
  at_last_scan_ = wheels_.back();
  scans_.push_back(scan);
}

WheelTurns CalibrationLog::at(Time stamp) const {
  if (wheels_.size() < 2) return wheels_.empty() ? WheelTurns{} : wheels_.front();
  const auto later = [](Time t, const WheelTurns& reading) { return t < reading.stamp; };
  auto after = std::upper_bound(wheels_.begin() + 1, wheels_.end() - 1, stamp, later);
  return between_two(*(after - 1), *after, stamp);
}

std::vector<WheelTurns> CalibrationLog::between(Time from, Time to) const {
  std::vector<WheelTurns> way{at(from)};
  const auto later = [](Time t, const WheelTurns& reading) { return t < reading.stamp; };
  for (auto next = std::upper_bound(wheels_.begin(), wheels_.end(), from, later);
       next != wheels_.end() && next->stamp < to; ++next)
    way.push_back(*next);
  way.push_back(at(to));
  for (std::size_t k = 1; k < way.size(); ++k) {
    const double most_rad = 2.0 * drive_.max_wheel_speed_radps * to_seconds(way[k].stamp - way[k - 1].stamp) + 1e-3;
    const double turned =
        std::max(std::fabs(way[k].left_rad - way[k - 1].left_rad), std::fabs(way[k].right_rad - way[k - 1].right_rad));
    if (way[k].stamp - way[k - 1].stamp > kLongestGap || turned > most_rad) return {};
  }
  return way;
}

}  // namespace jaywalk
