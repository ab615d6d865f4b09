#include "firmware/safety/scan_timing.h"

#include "firmware/safety/reaction.h"
#include "firmware/safety/trust.h"

namespace jaywalk {

bool ScanTiming::is_stale(const LaserScan& scan, Time now) noexcept {
  bool two_lost = false;
  if (scan.sequence != sequence_) {
    if (sequence_ != 0 && scan.sequence > sequence_ && scan.stamp != kNever) {
      const double periods = to_seconds(scan.stamp - stamp_) * rate_hz_;
      two_lost = periods - static_cast<double>(scan.sequence - sequence_) > kOldestScanPeriods - 1.0;
    }
    sequence_ = scan.sequence;
    stamp_ = scan.stamp;
  }
  // A scan is as old as its last beam; the stop zone reckons with the first.
  const Duration limit = duration_from_seconds(kOldestScanPeriods / rate_hz_) + sweep_of(scan, rate_hz_);
  return two_lost || is_older(scan.stamp, now, limit);
}

}  // namespace jaywalk
