#pragma once
// The times that pass between what a scan shows and wheels that obey it: SAFETY 7's t_scan + t_control + t_drive.
#include <algorithm>

#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"
#include "hal/types/scanners.h"
#include "hal/types/time.h"

namespace jaywalk {

/// What a running loop measures of itself and its drives.
struct MeasuredLatency {
  double tick_s = 0.0;   ///< from when a tick was due to its command: the worst of the last seconds
  double drive_s = 0.0;  ///< by how much the wheels' feedback follows the commands
};

/// Least and most that is reckoned with, s: a tick and a frame, and the drive's lag (50 ms in the plant). A tick that
/// takes longer is stopped by the stall guard; a drive that takes longer is a fault of its own.
inline constexpr MeasuredLatency kLeastLatency{0.01, 0.05}, kMostLatency{0.1, 0.3};
/// In all at least this, s, however fast loop and drives are.
inline constexpr double kLeastControlAndDrive_s = 0.08;

/// Ages of scans, in periods of the scanner. The stop zone reckons with the first at least. One scan may be lost and
/// its successor be half a period late, so that the second is the oldest that is accepted; a sweep may last the third.
inline constexpr double kScanPeriods = 1.5, kOldestScanPeriods = 2.5, kLongestSweepPeriods = 1.2;

/// A command holds for a period, so that the next tick may be as late again.
[[nodiscard]] inline double control_and_drive_s(Duration tick, const MeasuredLatency& measured) noexcept {
  const double tick_s = std::clamp(measured.tick_s, kLeastLatency.tick_s, kMostLatency.tick_s);
  const double drive_s = std::clamp(measured.drive_s, kLeastLatency.drive_s, kMostLatency.drive_s);
  return std::max(to_seconds(tick) + tick_s + drive_s, kLeastControlAndDrive_s);
}

/// With the oldest scan that is accepted and the slowest loop and drives that are reckoned with.
[[nodiscard]] inline double worst_reaction_s(double scan_rate_hz, Duration tick) noexcept {
  return (kOldestScanPeriods + kLongestSweepPeriods) / scan_rate_hz + control_and_drive_s(tick, kMostLatency);
}

/// What a scan says it took, within reason.
[[nodiscard]] inline Duration sweep_of(const LaserScan& scan, double rate_hz) noexcept {
  return std::clamp(scan.sweep, Duration{0}, duration_from_seconds(kLongestSweepPeriods / rate_hz));
}

/// The age (s) of its first beam that the stop zone reckons with: as old as a scan usually becomes before the next is
/// there, and as old as it is where that one was lost.
[[nodiscard]] inline double reckoned_age_s(const LaserScan& scan, Time now, double rate_hz) noexcept {
  const double usual_s = kScanPeriods / rate_hz + to_seconds(sweep_of(scan, rate_hz));
  return scan.stamp == kNever ? usual_s : std::max(usual_s, to_seconds(now - scan.stamp));
}

/// SAFETY 7's t_scan + t_control + t_drive (s), as the stop zone reckons with them now; of the scanner that is longest.
[[nodiscard]] inline double reaction_s(const OfEach<LaserScan>& scans, const OfEach<LaserModel>& lasers, Time now,
                                       Duration tick, const MeasuredLatency& measured) noexcept {
  double oldest_s = 0.0;
  for (std::size_t k = 0; k < lasers.size(); ++k)
    oldest_s = std::max(oldest_s, reckoned_age_s(scans[k], now, lasers[k].rate_hz));
  return oldest_s + control_and_drive_s(tick, measured);
}

}  // namespace jaywalk
