#pragma once
// Lines of recordings, and checks of scans, poses and stamps, for their readers.
#include <chrono>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/formats/logs/recorded_log.h"
#include "hal/text_file.h"
#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk::sim {

/// A text file, plain or gzip, a line at a time. Words are separated by spaces and tabs, or by commas where the line
/// has one: then they may be empty.
class LineFile {
 public:
  /// `expected` says what to give instead where there is no such file. Throws StartupError when the file cannot be
  /// read.
  explicit LineFile(const std::filesystem::path& file, const std::string& expected = "give the path of a recording");

  /// Moves on to the next line; false at the end. Throws StartupError for a damaged or cut .gz and for a line that is
  /// too long.
  [[nodiscard]] bool next_line();
  /// next_line() to the next line with words in it, the first of which does not begin with '#'.
  [[nodiscard]] bool next();
  /// The line without its end, be that "\n" or "\r\n"; valid until the next one.
  [[nodiscard]] const std::string& text() const { return text_; }
  /// The line's words, where it came by next(); valid until the next one.
  [[nodiscard]] const std::vector<std::string_view>& words() const { return words_; }
  /// Word `i` as a number; "nan" and "inf" are numbers. Throws StartupError where it is none.
  [[nodiscard]] double number(std::size_t i) const;
  /// Word `i` as a count of at most `most`. Throws StartupError where it is none or larger.
  [[nodiscard]] std::size_t count(std::size_t i, std::size_t most) const;
  /// Word `i` as seconds that fit the time line. Throws StartupError where it is not.
  [[nodiscard]] double seconds(std::size_t i) const;
  /// Words i, i + 1 and i + 2 as a pose.
  [[nodiscard]] Pose2 pose(std::size_t i) const { return {number(i), number(i + 1), number(i + 2)}; }

  [[nodiscard]] bool has_commas() const { return text_.find(',') != std::string::npos; }
  [[nodiscard]] std::string name() const { return file_.string(); }
  [[nodiscard]] std::size_t line() const { return line_; }
  [[nodiscard]] LogPlace place() const { return {name(), line_}; }
  /// Throws StartupError "FILE:LINE: cause; remedy" for the line at hand.
  [[noreturn]] void refuse(const std::string& cause, const std::string& remedy) const { place().refuse(cause, remedy); }

 private:
  void split();

  std::filesystem::path file_;
  std::optional<GzipFile> stream_;
  std::string block_;      ///< read last
  std::size_t taken_ = 0;  ///< bytes of it
  std::string text_;
  std::size_t line_ = 0;
  std::vector<std::string_view> words_;
};

inline constexpr const char* kWrongLength = "its number of words does not fit";
inline constexpr const char* kNoPose = "a pose that is none";
inline constexpr const char* kOtherClock = "its time is over an hour from the others'";
/// A tick lasts 20 ms: a clock that was set right would be replayed for ever.
inline constexpr Duration kOtherClockFrom = std::chrono::hours(1);

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Appends a scan and its ranges (m, one a beam). Readings of `nothing_from_m`, or 1 km, and over become infinite.
/// False where it was left out and counted: its beam angles or limits are invalid.
bool add_scan(RecordedLog& log, const LogPlace& place, RecordedScan scan, std::span<const double> ranges,
              double nothing_from_m);
/// Leaves out and counts scans of wrong times (judge_times): for each that was added whether it stays. `place`: theirs,
/// with any number.
std::vector<bool> settle_times(RecordedLog& log, LogPlace place);

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

  RecordedLog& log_;
  std::optional<Vec2> origin_;
  std::vector<OdometryPose> said_, without_speed_;
  Pose2 here_from_said_;  ///< from the frame of the poses at hand to that of the first
};

/// Throws StartupError where none of the odometry is of the scans' time; remarks on a second or more without odometry.
void compare_times(RecordedLog& log, const std::string& odometry_name);

/// add_scan() with the ranges in words [first_word, first_word + scan.beams).
bool add_scan(RecordedLog& log, const LineFile& file, const RecordedScan& scan, std::size_t first_word,
              double nothing_from_m);

}  // namespace jaywalk::sim
