#include "hal/sim/logs/scan_lines.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "hal/types/errors.h"

namespace jaywalk::sim {
namespace {

constexpr Duration kLongestGap =
    std::chrono::hours(1);                 // a tick lasts 20 ms: a clock set right would be replayed for ever
constexpr double kFarthestRange = 1000.0;  // m
constexpr double kFarForRobots = 100.0;    // m; what means "nothing" may be more, the same for each beam
constexpr std::size_t kLeastFar = 30;      // ranges: fewer are chance
constexpr double kFarthestPlace = 1e6;     // m

constexpr Duration kLeap = std::chrono::seconds(1);

}  // namespace

bool leapt(const std::optional<Time>& before, Time last, Time now) {
  return last - now > kLeap && (!before || now > *before);
}

bool add_scan(RecordedLog& log, const LineFile& file, RecordedScan scan, std::size_t first_word,
              double nothing_from_m) {
  if (!log.scans.empty() && scan.stamp <= log.scans.back().stamp) {
    log.refuse(file.name(), file.line(), kTimeStands);
    return false;
  }
  if (!log.scans.empty() && scan.stamp - log.scans.back().stamp > kLongestGap) {
    file.refuse("a scan more than an hour after the one before", "cut the recording here");
  }
  nothing_from_m = std::min(nothing_from_m, kFarthestRange);
  scan.range_max_m = std::min(scan.range_max_m, static_cast<float>(kFarthestRange));
  scan.first_range = log.range_m.size();
  double far = 0.0;  // the last of them
  for (std::size_t i = 0; i < scan.beams; ++i) {
    const double range = file.number(first_word + i);
    if (std::isfinite(range) && range > kFarForRobots) {
      if (far > 0.0 && std::fabs(range - far) > 0.5) ++log.far_ranges;
      far = range;
    }
    log.range_m.push_back(
        static_cast<float>(range >= nothing_from_m ? std::numeric_limits<double>::infinity() : range));
  }
  log.scans.push_back(scan);
  return true;
}

void require_scans(const RecordedLog& log, const LineFile& file, const std::string& expected) {
  if (log.far_ranges >= kLeastFar && 3 * log.far_ranges > log.range_m.size())
    throw StartupError(file.name() + ": a third of its ranges are over 100 m", "give metres: millimetres / 1000");
  if (!log.scans.empty()) return;
  const std::string place =
      log.refused.empty() ? file.name() : file.name() + ":" + std::to_string(log.refused.front().first_line);
  throw StartupError(place + ": no scan in it", "give a file of " + expected);
}

Pose2 sound_pose(const LineFile& file, const Pose2& pose) {
  const bool near = std::fabs(pose.x) <= kFarthestPlace && std::fabs(pose.y) <= kFarthestPlace;
  if (!near || !(std::fabs(pose.heading) < 1e4)) file.refuse("a pose that is none", "give metres and radians");
  return {pose.x, pose.y, wrap_angle(pose.heading)};
}

Pose2 pose_at(const LineFile& file, std::size_t i) {
  return sound_pose(file, {file.number(i), file.number(i + 1), file.number(i + 2)});
}

}  // namespace jaywalk::sim
