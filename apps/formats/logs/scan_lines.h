#pragma once
// What the readers of the text formats share.
#include "apps/formats/logs/line_file.h"
#include "apps/formats/logs/log_checks.h"

namespace jaywalk::sim {

inline constexpr const char* kWrongLength = "its number of words does not fit";

/// LogScans::add with the ranges in words [first_word, first_word + scan.beams).
bool add_scan(LogScans& scans, const LineFile& file, const RecordedScan& scan, std::size_t first_word,
              double nothing_from_m);

/// Word i, i + 1, i + 2 as a pose.
[[nodiscard]] Pose2 pose_at(const LineFile& file, std::size_t i);

}  // namespace jaywalk::sim
