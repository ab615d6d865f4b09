#pragma once
// A recording behind the HAL: the laser and the wheels say what they said then, commands go nowhere.
#include <memory>
#include <optional>

#include "apps/formats/logs/recorded_log.h"
#include "firmware/recording/recorded_hal.h"

namespace jaywalk::sim {

/// Time is the recording's own and stands still until the loop sleeps. Each device shows the newest
/// reading that is not younger than the clock; there is no outside localisation (sequence 0), and
/// no wheels either (sequence 0) where the recording has no odometry.
///
/// A scan appears at its stamp, though its sweep takes RecordedLog::sweep.
/// The constructor allocates, nothing else does. Thread: the loop's.
class LogReplay final : private Clock {
 public:
  /// Takes over the log, which has at least one scan.
  explicit LogReplay(RecordedLog log);
  LogReplay(const LogReplay&) = delete;
  LogReplay& operator=(const LogReplay&) = delete;

  [[nodiscard]] Hal hal() noexcept {
    const Hal hal = devices_.hal();
    return {hal.laser, hal.drive, hal.panel, hal.pose_source, *this};
  }
  /// What the operator wants from now on.
  void set_goal(Vec2 goal_in_map, double tolerance_m) noexcept {
    shown_->input.has_goal = true;
    shown_->input.goal_in_map = goal_in_map;
    shown_->input.goal_tolerance_m = tolerance_m;
  }

  /// True once the last scan has been reached.
  [[nodiscard]] bool ended() const noexcept { return shown_->now >= end_time(); }
  [[nodiscard]] Time start_time() const noexcept { return log_.scans.front().stamp; }
  [[nodiscard]] Time end_time() const noexcept { return log_.scans.back().stamp; }
  /// Where the odometry says that the robot was at start_time(); zero without odometry.
  [[nodiscard]] Pose2 start_pose() const noexcept;
  /// Where the recording says that it was at end_time(); nothing without odometry.
  [[nodiscard]] std::optional<Pose2> last_pose() const noexcept;
  /// The drive that the replayed wheel angles belong to, and how often it reports.
  [[nodiscard]] DriveModel drive() const;
  [[nodiscard]] const RecordedLog& log() const noexcept { return log_; }

 private:
  [[nodiscard]] Time now() noexcept override { return shown_->now; }
  void sleep_until(Time wake) noexcept override;
  void show(const RecordedScan& recorded) noexcept;

  RecordedLog log_;
  std::vector<WheelState> trail_;
  std::unique_ptr<TickRecord> shown_;  ///< newest readings
  RecordedHal devices_;
  std::size_t scans_seen_ = 0, wheels_seen_ = 0;  ///< number of readings that are no later than the clock
};

}  // namespace jaywalk::sim
