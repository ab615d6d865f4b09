#pragma once
// Times between a scan and wheels that obey it (SAFETY 7's t_scan + t_control + t_drive), and stale or broken readings.
#include <algorithm>
#include <array>
#include <cstdint>

#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"
#include "hal/types/time.h"
#include "hal/types/wheels.h"

namespace jaywalk {
/// Whether the supervisor may judge by a scan: not with another number of beams than this scanner has, directions that
/// are no numbers, or fewer than three beams that measured, free room too: a scanner broken, covered or blinded.
[[nodiscard]] bool is_trustworthy(const LaserScan& scan, const LaserModel& laser) noexcept;
[[nodiscard]] bool is_trustworthy(const WheelState& wheels) noexcept;

/// Whether what is stamped so is older at `now` than `limit`, or was never seen. A stamp more than 0.1 s ahead of now
/// (which a loop that wakes late may see) says nothing of its age: older than any limit.
[[nodiscard]] bool is_older(Time stamp, Time now, Duration limit) noexcept;

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

/// Ages of scans, in periods of the scanner: the least that the stop zone reckons with; the oldest that is accepted
/// (one is lost and the next half a period late); the longest of a sweep.
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

[[nodiscard]] inline Duration sweep_of(const LaserScan& scan, double rate_hz) noexcept {
  return std::clamp(scan.sweep, Duration{0}, duration_from_seconds(kLongestSweepPeriods / rate_hz));
}

/// SAFETY 7's t_scan + t_control + t_drive (s), as the stop zone reckons with them now; of the scanner that is longest.
[[nodiscard]] inline double reaction_s(const OfEach<LaserScan>& scans, const RobotModel& model, Time now, Duration tick,
                                       const MeasuredLatency& measured) noexcept {
  const OfEach<LaserModel> lasers = model.lasers();
  double oldest_s = 0.0;
  for (std::size_t k = 0; k < lasers.size(); ++k) {
    // Of its first beam: as old as a scan usually becomes before the next is there, and older where that one was lost.
    const double rate_hz = lasers[k].rate_hz,
                 usual_s = kScanPeriods / rate_hz + to_seconds(sweep_of(scans[k], rate_hz));
    oldest_s = std::max({oldest_s, usual_s, scans[k].stamp == kNever ? usual_s : to_seconds(now - scans[k].stamp)});
  }
  return oldest_s + control_and_drive_s(tick, model.drive.times, measured);
}

/// By how much the wheels' feedback follows the commands, s: of delays 10 ms apart the one with which the commands of
/// the last seconds explain the speeds felt best, in squares. Only while commands change can they be told apart.
class DriveResponse {
 public:
  explicit DriveResponse(const DriveModel& drive);

  /// Once a tick, with what was felt before and what is commanded now.
  void add(const WheelState& wheels, const WheelCommand& command) noexcept;
  /// 0 until it could be measured, and after a second of commands at rest; most_drive_s() at most, to a step of 10 ms.
  [[nodiscard]] double seconds() const noexcept { return seconds_; }

 private:
  static constexpr double kTelling_mps = 0.05;  ///< commands that differ by less tell nothing
  static constexpr std::size_t kMostDelays = 61, kKept = 128;
  static constexpr Duration kDelayStep = std::chrono::milliseconds(10);

  void forget_at_rest(const WheelCommand& command) noexcept;
  [[nodiscard]] const WheelCommand* command_at(Time time) const noexcept;
  [[nodiscard]] bool changed_before(Time time) const noexcept;

  double telling_radps_;
  std::size_t delays_;
  double longest_s_;                            ///< that one reading stands for
  std::array<WheelCommand, kKept> commands_{};  ///< a ring: 0.64 s at 200 Hz
  std::size_t count_ = 0;
  std::uint32_t seen_ = 0;
  Time told_ = kNever, moved_{};  ///< last report that told; last command that was not at rest
  double told_s_ = 0.0;
  std::array<double, kMostDelays> misfit_{};
  double seconds_ = 0.0;
};

/// What a running loop measures of itself and its drives, for the stop zone. Thread: the loop's.
class Latency {
 public:
  explicit Latency(const DriveModel& drive) : response_(drive) {}

  /// At the end of a tick that began at `now` and took until its command was out.
  void add(Time now, Duration took, const WheelState& wheels, const WheelCommand& command) noexcept;
  [[nodiscard]] MeasuredLatency measured() const noexcept {
    return {to_seconds(std::max(worst_, worst_before_)), response_.seconds()};
  }

 private:
  static constexpr Duration kSpan = std::chrono::seconds(5);  ///< the worst tick counts for one to two of these

  DriveResponse response_;
  Time span_began_ = kNever;
  Duration worst_{0}, worst_before_{0};
};

/// Whether scans come in time: one may be lost, two in a row may not (SAFETY 3). Thread: the loop's.
class ScanTiming {
 public:
  explicit ScanTiming(double rate_hz) : rate_hz_(rate_hz) {}

  /// Once a tick, with the newest scan. True where none ever came, its last beam is older than two and a half periods,
  /// it is stamped more than 0.1 s ahead, or two were lost just before it, which a slow loop may not see missing.
  [[nodiscard]] bool is_stale(const LaserScan& scan, Time now) noexcept;

 private:
  double rate_hz_;
  std::uint32_t sequence_ = 0;
  Time stamp_ = kNever;
};

}  // namespace jaywalk
