#pragma once
// Checks of scans, poses and stamps that every reader of recordings makes.
#include <chrono>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/formats/logs/line_file.h"
#include "apps/formats/logs/recorded_log.h"
#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk::sim {

inline constexpr const char* kTimeStands = "its time does not grow";
inline constexpr const char* kTimeLeapt = "its time is ahead of those after it";
inline constexpr const char* kOtherClock = "its time is over an hour from the others'";
/// A tick lasts 20 ms: a clock that was set right would be replayed for ever.
inline constexpr Duration kOtherClockFrom = std::chrono::hours(1);

/// A cause for each stamp that is left out, nullptr for those that are kept, in the order of `stamps`: that of
/// recording. Kept are, of the largest group without a gap of an hour, those of the longest sequence that rises
/// strictly: a clock that was set right on the way costs the fewest.
[[nodiscard]] std::vector<const char*> judge_times(std::span<const Time> stamps);

// Whether the times in a recording can be the laser's, and even ones where they cannot.

/// Some recordings were stamped by a program that went through them later: a dozen scans share a stamp while the robot
/// drives two metres, and times between them tell how long that program took. Where that is so in five lines, and
/// one of a hundred, no time in the file is of use: give the lines out again, evenly between the first stamp and the
/// last.
class LineClock {
 public:
  /// A line's stamp, and how the robot moved since the line before.
  void see(Time said, const Pose2& moved) noexcept;

  /// Whether the stamps seen cannot be the laser's.
  [[nodiscard]] bool wrong() const { return stood_ >= kFewest && stood_ * kOneLineIn > lines_; }
  /// Lines in which the robot drove though time stood still.
  [[nodiscard]] std::size_t stood() const { return stood_; }

  /// Evenly spaced time of line `k`, from the first stamp to the last; at 10 Hz where both are the same.
  [[nodiscard]] Time even(std::size_t k) const;

 private:
  static constexpr std::size_t kFewest = 5, kOneLineIn = 100;

  std::size_t lines_ = 0, stood_ = 0;
  Time first_ = kNever, last_ = kNever;
};

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// The scans of a log, in the order of recording. add() skips and counts scans with invalid beam angles;
/// settle_times() skips and counts scans with wrong stamps (judge_times).
class LogScans {
 public:
  explicit LogScans(RecordedLog& log) : log_(log) {}

  /// Appends `ranges` (m, one a beam) and the scan itself. Readings of `nothing_from_m`, or 1 km, and over become
  /// infinite. False where it was left out.
  bool add(const LogPlace& place, RecordedScan scan, std::span<const double> ranges, double nothing_from_m);
  /// Leaves out those of wrong times: for each that was added whether it stays. `place`: theirs, with any number.
  std::vector<bool> settle_times(LogPlace place);

 private:
  RecordedLog& log_;
  std::vector<std::size_t> numbers_;  ///< where each stands
};

/// Removes of `list` what does not stay.
template <class Item>
void keep(std::vector<Item>& list, const std::vector<bool>& stays) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < list.size(); ++k)
    if (stays[k]) list[kept++] = list[k];
  list.resize(kept);
}

/// Throws StartupError where no scan was read, naming the first place that was refused and why, and where a third of
/// the ranges are over 100 m.
void require_scans(const RecordedLog& log, const std::string& file, const std::string& expected);

/// Gaps between scans, of over half a second and five of their periods: the remark tells each.
void remark_gaps(RecordedLog& log, const std::string& file);

/// `pose`, its heading wrapped. Nothing where it is NaN or lies beyond 1000 km.
[[nodiscard]] std::optional<Pose2> sound_pose(const Pose2& pose);
inline constexpr const char* kNoPose = "a pose that is none";

/// Odometry that may begin anew on its way, in the order of recording; the scans are known.
class LogOdometry {
 public:
  explicit LogOdometry(RecordedLog& log) : log_(log) {}

  /// A pose as the recording says it. One that is none is left out and counted, so is one with a speed that is none.
  /// Poses in UTM or the like, farther off than a map may reach, are taken relative to the first.
  void add(const OdometryPose& said, const LogPlace& place);
  /// Appends the poses to the log, without those that have wrong stamps (judge_times) or stamps over an hour from the
  /// scans. A pose farther from the last than a robot drives begins the odometry anew there. Where no speed is a
  /// number, poses alone count. Throws StartupError where no pose is left; it says why the first was left out.
  void settle(LogPlace place);

 private:
  void leave_out_distant_times(const LogPlace& place);
  void append(OdometryPose said, const LogPlace& place);
  [[nodiscard]] bool jumps(const OdometryPose& last, const OdometryPose& said) const;

  struct Said {
    OdometryPose pose;
    std::size_t number = 0;
  };
  RecordedLog& log_;
  std::optional<Vec2> origin_;
  std::vector<Said> said_, without_speed_;
  Pose2 here_from_said_;  ///< from the frame of the poses at hand to that of the first
};

/// Two clocks that were never set by one another give times that do not meet: an error where none of the odometry is of
/// the scans' time, a remark from a second without it on.
void compare_times(RecordedLog& log, const std::string& odometry_name);

// What the readers of the text formats share.

inline constexpr const char* kWrongLength = "its number of words does not fit";

/// LogScans::add with the ranges in words [first_word, first_word + scan.beams).
bool add_scan(LogScans& scans, const LineFile& file, const RecordedScan& scan, std::size_t first_word,
              double nothing_from_m);

/// Word i, i + 1, i + 2 as a pose.
[[nodiscard]] Pose2 pose_at(const LineFile& file, std::size_t i);

}  // namespace jaywalk::sim
