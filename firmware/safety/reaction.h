#pragma once
// The times that pass between what a scan shows and wheels that obey it: SAFETY 7's t_scan + t_control + t_drive.
#include <algorithm>

#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"
#include "hal/types/time.h"

namespace jaywalk {

/// What a running loop measures of itself and its drives.
struct MeasuredLatency {
  double tick_s = 0.0;   ///< from when a tick was due to its command: the worst of the last seconds
  double drive_s = 0.0;  ///< by how much the wheels' feedback follows the commands
};

/// Least and most of a tick and its frame that is reckoned with, s. The stall guard stops a tick that takes longer.
inline constexpr double kLeastTick_s = 0.01, kMostTick_s = 0.1;
/// Most of a usual drive that is reckoned with, s; a slower one has DriveTimes::slower_s() more.
inline constexpr double kMostDrive_s = 0.3;
/// In all at least this, s, however fast loop and drives are.
inline constexpr double kLeastControlAndDrive_s = 0.08;

/// Ages of scans, in periods of the scanner. The stop zone reckons with the first at least. One scan may be lost and
/// its successor be half a period late, so that the second is the oldest that is accepted; a sweep may last the third.
inline constexpr double kScanPeriods = 1.5, kOldestScanPeriods = 2.5, kLongestSweepPeriods = 1.2;

/// Age up to which the wheels' newest reading is no fault. Of the loop's own readings, too, one may be lost.
[[nodiscard]] inline Duration oldest_wheels(const DriveTimes& drive, Duration tick) noexcept {
  constexpr Duration kUsual = std::chrono::milliseconds(60);  // three ticks of 50 Hz
  return std::max({kUsual, 5 * tick / 2, duration_from_seconds(drive.oldest_report_s())});
}

/// Longest response of a drive that is reckoned with, s. One that takes longer is a fault (Supervisor).
[[nodiscard]] inline double most_drive_s(const DriveTimes& drive) noexcept {
  return kMostDrive_s + drive.slower_s(DriveTimes{}.report_s);
}

/// A command holds for a period, so that the next tick may be as late again. A drive is at best as fast as it states.
[[nodiscard]] inline double control_and_drive_s(Duration tick, const DriveTimes& drive,
                                                const MeasuredLatency& measured) noexcept {
  const double tick_s = std::clamp(measured.tick_s, kLeastTick_s, kMostTick_s);
  const double drive_s = std::clamp(measured.drive_s, drive.response_s, most_drive_s(drive));
  return std::max(to_seconds(tick) + tick_s + drive_s, kLeastControlAndDrive_s);
}

/// With the oldest scan that is accepted and the slowest loop and drives that are reckoned with.
[[nodiscard]] inline double worst_reaction_s(const RobotModel& model, Duration tick) noexcept {
  double slowest_hz = model.laser.rate_hz;
  for (const LaserModel& laser : model.other_lasers) slowest_hz = std::min(slowest_hz, laser.rate_hz);
  return (kOldestScanPeriods + kLongestSweepPeriods) / slowest_hz +
         control_and_drive_s(tick, model.drive.times, {kMostTick_s, most_drive_s(model.drive.times)});
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
[[nodiscard]] inline double reaction_s(const OfEach<LaserScan>& scans, const RobotModel& model, Time now, Duration tick,
                                       const MeasuredLatency& measured) noexcept {
  const OfEach<LaserModel> lasers = model.lasers();
  double oldest_s = 0.0;
  for (std::size_t k = 0; k < lasers.size(); ++k)
    oldest_s = std::max(oldest_s, reckoned_age_s(scans[k], now, lasers[k].rate_hz));
  return oldest_s + control_and_drive_s(tick, model.drive.times, measured);
}

}  // namespace jaywalk
