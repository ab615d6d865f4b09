#pragma once
#include <array>
#include <chrono>
#include <utility>

#include "hal/types/laser_scan.h"
#include "hal/types/scanners.h"
#include "hal/types/time.h"

namespace jaywalk {

/// Scans of several scanners come when their sweeps end, so that a slow sweep comes after a later one of another
/// scanner. Tells that from a clock that was set back: such a scan goes on from its own scanner's last.
class ScanOrder {
 public:
  /// Once a scan: how much earlier (s, 0 or less) it was taken than the newest of another scanner.
  [[nodiscard]] double behind_s(const LaserScan& scan) noexcept {
    Time& own = own_[scan.scanner];
    const bool late = newest_ != kNever && scan.stamp > own && scan.stamp < newest_ && newest_ - scan.stamp < kMost;
    before_ = std::exchange(own, scan.stamp);
    if (late) return to_seconds(scan.stamp - newest_);
    newest_ = scan.stamp;
    return 0.0;
  }
  /// When the scanner of the last scan asked about took the one before; kNever: it is its first.
  [[nodiscard]] Time before() const noexcept { return before_; }

 private:
  static constexpr Duration kMost = std::chrono::seconds(1);  ///< no sweep takes longer
  std::array<Time, kMostScanners> own_ = filled();
  Time newest_ = kNever, before_ = kNever;

  static constexpr std::array<Time, kMostScanners> filled() noexcept {
    std::array<Time, kMostScanners> times{};
    times.fill(kNever);
    return times;
  }
};

}  // namespace jaywalk
