#pragma once
#include <cstdint>

#include "hal/types/laser_scan.h"

namespace jaywalk {

/// Whether scans come in time: one may be lost, two in a row may not (SAFETY 3). It counts in seconds, so that it does
/// not depend on how often the loop looks. Thread: the loop's.
class ScanTiming {
 public:
  explicit ScanTiming(double rate_hz) : rate_hz_(rate_hz) {}

  /// Once a tick, with the newest scan. True where none ever came, where its last beam is older than two and a half
  /// periods, where it is stamped more than 0.1 s ahead, and where two were lost just before it: a loop slower than the
  /// scanner may not see them missing.
  [[nodiscard]] bool is_stale(const LaserScan& scan, Time now) noexcept;

 private:
  double rate_hz_;
  std::uint32_t sequence_ = 0;
  Time stamp_ = kNever;
};

}  // namespace jaywalk
