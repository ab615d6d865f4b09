#pragma once
// What the readers of the text formats share.
#include "hal/sim/logs/line_file.h"
#include "hal/sim/logs/recorded_log.h"

namespace jaywalk::sim {

inline constexpr const char* kTimeStands = "its time does not grow";
inline constexpr const char* kTimeLeapt = "the one before it is ahead of its time";
inline constexpr const char* kWrongLength = "its number of words does not fit";

/// Whether the last stamp stands alone, more than a second ahead of those before and after it.
[[nodiscard]] bool leapt(const std::optional<Time>& before, Time last, Time now);

/// Appends the ranges in words [first_word, first_word + scan.beams) and the scan itself, unless its
/// time does not grow. Readings of `nothing_from_m`, or 1 km, and over become infinite. False when refused.
/// Throws StartupError for a scan more than an hour after the one before.
bool add_scan(RecordedLog& log, const LineFile& file, RecordedScan scan, std::size_t first_word, double nothing_from_m);

/// Throws StartupError where no scan was read, naming the first line that was refused.
void require_scans(const RecordedLog& log, const LineFile& file, const std::string& expected);

/// `pose`, its heading wrapped. Throws StartupError when it is NaN or lies beyond 1000 km.
[[nodiscard]] Pose2 sound_pose(const LineFile& file, const Pose2& pose);
/// Word i, i + 1, i + 2 as a sound pose.
[[nodiscard]] Pose2 pose_at(const LineFile& file, std::size_t i);

}  // namespace jaywalk::sim
