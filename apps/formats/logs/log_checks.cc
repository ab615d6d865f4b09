#include "apps/formats/logs/log_checks.h"

#include <algorithm>
#include <cmath>

#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk::sim {
namespace {

constexpr const char* kTimeStands = "its time does not grow";
constexpr const char* kTimeLeapt = "its time is ahead of those after it";
constexpr Duration kLeap = std::chrono::seconds(1);  // a stamp so far ahead of a later one is the wrong one of the two

/// First and last stamp of the largest group without such a gap; the earliest of groups of equal size.
std::pair<Time, Time> largest_group(std::span<const Time> stamps) {
  std::vector<Time> sorted(stamps.begin(), stamps.end());
  std::sort(sorted.begin(), sorted.end());
  std::size_t begin = 0, best = 0, most = 0;
  for (std::size_t k = 1; k <= sorted.size(); ++k) {
    if (k < sorted.size() && sorted[k] - sorted[k - 1] <= kOtherClockFrom) continue;
    if (k - begin > most) most = k - begin, best = begin;
    begin = k;
  }
  return {sorted[best], sorted[best + most - 1]};
}

/// The longest sequence of `stamps[of[...]]` that rises strictly, by patience sorting: places in `stamps`. Of several
/// one that ends within a second of the earliest end, recorded first, and spans the least.
std::vector<std::size_t> longest_rising(std::span<const Time> stamps, const std::vector<std::size_t>& of) {
  std::vector<std::vector<std::size_t>> ends;  // what a longest sequence of each length ends with; stamps fall
  for (const std::size_t k : of) {
    const auto place = std::lower_bound(ends.begin(), ends.end(), stamps[k],
                                        [&](const auto& end, Time stamp) { return stamps[end.back()] < stamp; });
    if (place == ends.end())
      ends.push_back({k});
    else
      place->push_back(k);
  }
  std::vector<std::size_t> rising;
  for (auto end = ends.rbegin(); end != ends.rend(); ++end) {
    const Time before = rising.empty() ? stamps[end->back()] + kLeap + Duration{1} : stamps[rising.back()];
    rising.push_back(*std::find_if(end->begin(), end->end(), [&](std::size_t k) { return stamps[k] < before; }));
  }
  std::reverse(rising.begin(), rising.end());
  return rising;
}

/// A cause for each stamp that is left out, nullptr for those that are kept, in the order of recording. Kept are, of
/// the largest group without a gap of an hour, those of the longest sequence that rises strictly: a clock that was set
/// right on the way costs the fewest.
template <class Stamped>
std::vector<const char*> judge_times(const std::vector<Stamped>& recorded) {
  std::vector<Time> stamps;
  for (const Stamped& one : recorded) stamps.push_back(one.stamp);
  std::vector<const char*> causes(stamps.size(), kOtherClock);
  if (stamps.empty()) return causes;
  const auto [first, last] = largest_group(stamps);
  std::vector<std::size_t> inside;
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    if (stamps[k] < first || stamps[k] > last) continue;
    inside.push_back(k);
    causes[k] = kTimeStands;
  }
  const std::vector<std::size_t> rising = longest_rising(stamps, inside);
  std::size_t next = 0;  // the first kept one that is not before k
  for (const std::size_t k : inside) {
    while (next < rising.size() && rising[next] < k) ++next;
    if (next == rising.size()) continue;
    if (rising[next] == k)
      causes[k] = nullptr;
    else if (stamps[k] > stamps[rising[next]])
      causes[k] = kTimeLeapt;
  }
  return causes;
}

constexpr double kFarthestRange = 1000.0;  // m
constexpr double kFarForRobots = 100.0;    // m; what means "nothing" may be more, the same for each beam
constexpr std::size_t kLeastFar = 30;      // ranges: fewer are chance
constexpr double kFarthestPlace = 1e6;     // m
constexpr double kFarthestInMapM = 1e5, kFarthestOnEarthM = 4e7;  // places in maps (TomlTable); around the Earth
constexpr float kTurn = static_cast<float>(2.0 * kPi);
constexpr double kFastest = 1000.0;                     // m/s, rad/s
constexpr double kJumpM = 0.5, kFastestDriveMps = 5.0;  // farther in the time: odometry that was set anew
constexpr double kMostWithoutS = 1.0;                   // of the scans' time without odometry: no word of it
constexpr double kGapS = 0.5, kGapPeriods = 5.0;

/// Why a scan makes no fan; empty where it does.
std::string fault_of(const RecordedScan& scan) {
  if (scan.beams == 0) return "it is empty";
  if (scan.beams > kMaxBeams) return std::to_string(scan.beams) + " beams, over " + std::to_string(kMaxBeams);
  const bool fan = std::fabs(scan.first_angle_rad) <= kTurn && std::fabs(scan.angle_step_rad) <= kTurn;
  if (!fan || scan.angle_step_rad == 0.0F) return "beam angles that make no fan";
  const bool limits = scan.range_max_m > scan.range_min_m && scan.range_min_m >= 0.0F;
  return limits ? "" : "range limits that hold nothing";
}

}  // namespace

bool add_scan(RecordedLog& log, const LogPlace& place, RecordedScan scan, std::span<const double> ranges,
              double nothing_from_m) {
  if (const std::string fault = fault_of(scan); !fault.empty()) {
    log.refuse(place, fault);
    return false;
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
  scan.number = place.number;
  log.scans.push_back(scan);
  return true;
}

std::vector<bool> settle_times(RecordedLog& log, LogPlace place) {
  const std::vector<const char*> causes = judge_times(log.scans);
  std::vector<bool> stays;
  std::vector<float> ranges;
  for (std::size_t k = 0; k < causes.size(); ++k) {
    stays.push_back(causes[k] == nullptr);
    RecordedScan& scan = log.scans[k];
    if (stays.back()) {
      const auto from = log.range_m.begin() + static_cast<std::ptrdiff_t>(scan.first_range);
      scan.first_range = ranges.size();
      ranges.insert(ranges.end(), from, from + scan.beams);
    } else {
      place.number = scan.number;
      log.refuse(place, causes[k]);
    }
  }
  keep(log.scans, stays);
  log.range_m = std::move(ranges);
  return stays;
}

void require_scans(const RecordedLog& log, const std::string& file, const std::string& expected) {
  if (log.far_ranges >= kLeastFar && 3 * log.far_ranges > log.range_m.size())
    throw StartupError(file + ": a third of its ranges are over 100 m", "give metres: millimetres / 1000");
  if (!log.scans.empty()) return;
  if (log.refused.empty()) throw StartupError(file + ": no scan in it", "give a file of " + expected);
  const RefusedLines& first = log.refused.front();
  first.place.refuse("no scan in it: " + first.cause, "give a file of " + expected);
}

void remark_gaps(RecordedLog& log, const std::string& file) {
  constexpr std::size_t kMostTold = 8;
  const double least_s = std::max(kGapS, kGapPeriods / std::max(log.laser().rate_hz, 1e-3));
  std::string told;
  std::size_t gaps = 0;
  for (std::size_t k = 1; k < log.scans.size(); ++k) {
    const double gap_s = to_seconds(log.scans[k].stamp - log.scans[k - 1].stamp);
    if (gap_s < least_s || ++gaps > kMostTold) continue;
    told += formatted("%s%.1f s from %.1f s on", told.empty() ? "" : ", ", gap_s,
                      to_seconds(log.scans[k - 1].stamp - log.scans.front().stamp));
  }
  if (gaps > kMostTold) told += " and " + std::to_string(gaps - kMostTold) + " more";
  if (gaps > 0) log.add_remark(file + ": no scans for " + told);
}

std::optional<Pose2> sound_pose(const Pose2& pose) {
  const bool near = std::fabs(pose.x) <= kFarthestPlace && std::fabs(pose.y) <= kFarthestPlace;
  if (!near || !(std::fabs(pose.heading) < 1e4)) return std::nullopt;
  return Pose2{pose.x, pose.y, wrap_angle(pose.heading)};
}

void LogOdometry::add(const OdometryPose& said, const LogPlace& place) {
  const Vec2 at = said.pose.position();
  if (!origin_ && norm(at) < kFarthestOnEarthM) {
    origin_ = norm(at) > kFarthestInMapM ? at : Vec2{};
    if (*origin_ != Vec2{})
      log_.add_remark(place.file + formatted(": positions are relative to the first, %.1f, %.1f m", at.x, at.y));
  }
  const Vec2 near = at - origin_.value_or(Vec2{});
  const std::optional<Pose2> pose = sound_pose({near.x, near.y, said.pose.heading});
  if (!pose) return log_.refuse(place, kNoPose);
  const Twist2 twist = said.twist.value_or(Twist2{});
  if (std::fabs(twist.v_mps) <= kFastest && std::fabs(twist.w_radps) <= kFastest)
    said_.push_back({said.stamp, *pose, said.twist, place.number});
  else
    without_speed_.push_back({said.stamp, *pose, std::nullopt, place.number});
}

void LogOdometry::settle(LogPlace place) {
  if (said_.empty()) std::swap(said_, without_speed_);
  for (const OdometryPose& said : without_speed_) {
    place.number = said.number;
    log_.refuse(place, "a speed that is none");
  }
  leave_out_distant_times(place);
  const std::vector<const char*> causes = judge_times(said_);
  for (std::size_t k = 0; k < said_.size(); ++k) {
    place.number = said_[k].number;
    if (causes[k] == nullptr) append(said_[k], place);
    if (causes[k] != nullptr) log_.refuse(place, causes[k]);
  }
  if (!log_.odometry.empty()) return;
  for (const RefusedLines& refused : log_.refused) {
    if (refused.place.file == place.file)
      refused.place.refuse("no odometry in it: " + refused.cause, "give other odometry, or the scans alone");
  }
}

/// Unless all are: then the clocks were never set by one another, which compare_times tells.
void LogOdometry::leave_out_distant_times(const LogPlace& place) {
  const auto is_near = [&](const OdometryPose& said) {
    return said.stamp + kOtherClockFrom >= log_.scans.front().stamp &&
           said.stamp - kOtherClockFrom <= log_.scans.back().stamp;
  };
  if (std::none_of(said_.begin(), said_.end(), is_near)) return;
  std::erase_if(said_, [&](const OdometryPose& said) {
    if (is_near(said)) return false;
    log_.refuse({place.file, said.number, place.unit}, kOtherClock);
    return true;
  });
}

void LogOdometry::append(OdometryPose said, const LogPlace& place) {
  const Pose2 here = here_from_said_ * said.pose;
  if (!log_.odometry.empty()) {
    const OdometryPose& last = log_.odometry.back();
    const double drives_m = kJumpM + kFastestDriveMps * to_seconds(said.stamp - last.stamp);
    if (distance(here.position(), last.pose.position()) > drives_m) {
      here_from_said_ = last.pose * inverse(said.pose);
      return log_.refuse(place, "it jumps farther than robots drive: taken to begin anew there");
    }
  }
  said.pose = here;
  log_.odometry.push_back(said);
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
  log.add_remark(odometry_name +
                 formatted(": nothing of %.1f of the %.1f s of scans: no wheels there", without_s, all_s));
}

bool add_scan(RecordedLog& log, const LineFile& file, const RecordedScan& scan, std::size_t first_word,
              double nothing_from_m) {
  std::vector<double> ranges(scan.beams);
  for (std::size_t i = 0; i < scan.beams; ++i) ranges[i] = file.number(first_word + i);
  return add_scan(log, file.place(), scan, ranges, nothing_from_m);
}

}  // namespace jaywalk::sim
