#include "apps/formats/logs/log_checks.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "hal/types/errors.h"

namespace jaywalk::sim {
namespace {

constexpr Duration kLongestGap =
    std::chrono::hours(1);                 // a tick lasts 20 ms: a clock set right would be replayed for ever
constexpr double kFarthestRange = 1000.0;  // m
constexpr double kFarForRobots = 100.0;    // m; what means "nothing" may be more, the same for each beam
constexpr std::size_t kLeastFar = 30;      // ranges: fewer are chance
constexpr double kFarthestPlace = 1e6;     // m
constexpr float kTurn = static_cast<float>(2.0 * kPi);
constexpr double kFastest = 1000.0;                     // m/s, rad/s
constexpr double kJumpM = 0.5, kFastestDriveMps = 5.0;  // farther in the time: odometry that was set anew
constexpr double kMostWithoutS = 1.0;                   // of the scans' time without odometry: no word of it
constexpr Duration kLeap = std::chrono::seconds(1);

/// Whether the last stamp stands alone, more than a second ahead of those before and after it.
template <class Stamped>
bool last_leapt(const std::vector<Stamped>& list, Time now) {
  if (list.empty() || list.back().stamp - now <= kLeap) return false;
  return list.size() < 2 || now > list[list.size() - 2].stamp;
}

}  // namespace

void check_scan(const LogPlace& place, const RecordedScan& scan) {
  if (scan.beams == 0 || scan.beams > kMaxBeams) {
    place.refuse(std::to_string(scan.beams) + " beams",
                 "give scans of 1 to " + std::to_string(kMaxBeams) + " beams, or leave some out");
  }
  const bool fan = std::fabs(scan.first_angle_rad) <= kTurn && std::fabs(scan.angle_step_rad) <= kTurn;
  if (!fan || scan.angle_step_rad == 0.0F) place.refuse("beam angles that make no fan", "give angles in radians");
  if (!(scan.range_max_m > scan.range_min_m && scan.range_min_m >= 0.0F)) {
    place.refuse("range limits that hold nothing", "give 0 <= range_min < range_max, in metres");
  }
}

void drop_leapt_scan(RecordedLog& log, const LogPlace& place, Time now) {
  if (!last_leapt(log.scans, now)) return;
  log.range_m.resize(log.scans.back().first_range);
  log.scans.pop_back();
  log.refuse(place, kTimeLeapt);
}

bool add_scan(RecordedLog& log, const LogPlace& place, RecordedScan scan, std::span<const double> ranges,
              double nothing_from_m) {
  if (!log.scans.empty() && scan.stamp <= log.scans.back().stamp) {
    log.refuse(place, kTimeStands);
    return false;
  }
  if (!log.scans.empty() && scan.stamp - log.scans.back().stamp > kLongestGap) {
    place.refuse("a scan more than an hour after the one before", "cut the recording here");
  }
  nothing_from_m = std::min(nothing_from_m, kFarthestRange);
  scan.range_max_m = std::min(scan.range_max_m, static_cast<float>(kFarthestRange));
  scan.first_range = log.range_m.size();
  double far = 0.0;  // the last of them
  for (const double range : ranges) {
    if (std::isfinite(range) && range > kFarForRobots) {
      if (far > 0.0 && std::fabs(range - far) > 0.5) ++log.far_ranges;
      far = range;
    }
    log.range_m.push_back(static_cast<float>(range >= nothing_from_m ? kNoLimit : range));
  }
  log.scans.push_back(scan);
  return true;
}

void require_scans(const RecordedLog& log, const std::string& file, const std::string& expected) {
  if (log.far_ranges >= kLeastFar && 3 * log.far_ranges > log.range_m.size())
    throw StartupError(file + ": a third of its ranges are over 100 m", "give metres: millimetres / 1000");
  if (!log.scans.empty()) return;
  const std::string place = log.refused.empty() ? file : file + ":" + std::to_string(log.refused.front().first_line);
  throw StartupError(place + ": no scan in it", "give a file of " + expected);
}

Pose2 sound_pose(const LogPlace& place, const Pose2& pose) {
  const bool near = std::fabs(pose.x) <= kFarthestPlace && std::fabs(pose.y) <= kFarthestPlace;
  if (!near || !(std::fabs(pose.heading) < 1e4)) place.refuse("a pose that is none", "give metres and radians");
  return {pose.x, pose.y, wrap_angle(pose.heading)};
}

void OdometryPoses::add(const OdometryPose& said, const LogPlace& place) {
  const Twist2 twist = said.twist.value_or(Twist2{});
  if (!(std::fabs(twist.v_mps) <= kFastest && std::fabs(twist.w_radps) <= kFastest)) {
    place.refuse("a speed that is none", "give m/s and rad/s, or delete the " + place.unit);
  }
  if (last_leapt(log_.odometry, said.stamp)) {
    log_.odometry.pop_back();
    log_.refuse(place, kTimeLeapt);
  }
  if (!log_.odometry.empty() && said.stamp <= log_.odometry.back().stamp) {
    log_.refuse(place, kTimeStands);
  } else if (!log_.odometry.empty() && jumps(log_.odometry.back(), said)) {
    here_from_said_ = log_.odometry.back().pose * inverse(said.pose);
    log_.refuse(place, "it jumps farther than robots drive: taken to begin anew there");
  } else {
    log_.odometry.push_back({said.stamp, here_from_said_ * said.pose, said.twist});
  }
}

bool OdometryPoses::jumps(const OdometryPose& last, const OdometryPose& said) const {
  const double drives_m = kJumpM + kFastestDriveMps * to_seconds(said.stamp - last.stamp);
  return distance((here_from_said_ * said.pose).position(), last.pose.position()) > drives_m;
}

void compare_times(RecordedLog& log, const std::string& odometry_name) {
  const Time begin = std::max(log.scans.front().stamp, log.odometry.front().stamp);
  const Time end = std::min(log.scans.back().stamp, log.odometry.back().stamp);
  if (end < begin) {
    throw StartupError(odometry_name + ": all of it lies before the scans or after them",
                       "give both by one clock, or the scans alone");
  }
  const double all_s = to_seconds(log.scans.back().stamp - log.scans.front().stamp);
  const double without_s = all_s - to_seconds(end - begin);
  if (without_s < kMostWithoutS) return;
  char text[80];
  std::snprintf(text, sizeof text, ": nothing of %.1f of the %.1f s of scans: no wheels there", without_s, all_s);
  log.remark = odometry_name + text;
}

}  // namespace jaywalk::sim
