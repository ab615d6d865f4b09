#pragma once
#include <array>
#include <cstdint>

#include "firmware/safety/reaction.h"
#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"

namespace jaywalk {

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
  [[nodiscard]] MeasuredLatency measured() const noexcept;

 private:
  static constexpr Duration kSpan = std::chrono::seconds(5);  ///< the worst tick counts for one to two of these

  DriveResponse response_;
  Time span_began_ = kNever;
  Duration worst_{0}, worst_before_{0};
};

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
