#include "tests/perception/recordings.h"

#include <algorithm>
#include <cmath>

#include "apps/formats/logs/log_checks.h"

namespace jaywalk::recordings {
namespace {

/// Appends a scan whose ranges are the line's words from `first` on.
void add_scan(Recording& to, const sim::LineFile& line, double t_s, std::size_t first, std::size_t count,
              const LaserScan& like) {
  LaserScan& scan = to.scans.emplace_back(like);
  scan.stamp = time_from_seconds(t_s);
  scan.sequence = static_cast<std::uint32_t>(to.scans.size());
  scan.beam_count = static_cast<std::uint32_t>(count);
  for (std::size_t k = 0; k < count; ++k) scan.range_m[k] = static_cast<float>(line.number(first + k));
}

/// One scan a turn, at most ten times a second: what a replay takes these lasers for (sim::RecordedLog).
void spin(std::vector<LaserScan>& scans) {
  const double seconds = to_seconds(scans.back().stamp - scans.front().stamp);
  const double turn_s = std::min(0.1, seconds / static_cast<double>(scans.size() - 1));
  for (LaserScan& scan : scans) {
    const double fan = static_cast<double>(scan.angle_step_rad) * (scan.beam_count - 1);
    scan.sweep = duration_from_seconds(turn_s * fan / (2.0 * kPi));
  }
}

}  // namespace

Recording read_scan_odom(const std::filesystem::path& scans, const std::optional<std::filesystem::path>& odometry) {
  Recording out;
  for (sim::LineFile line(scans); line.next();) {
    LaserScan like;
    like.first_angle_rad = static_cast<float>(line.number(1));
    like.angle_step_rad = static_cast<float>(line.number(2));
    like.range_min_m = static_cast<float>(line.number(3));
    like.range_max_m = static_cast<float>(line.number(4));
    add_scan(out, line, line.number(0), 6, line.count(5, kMaxBeams), like);
  }
  spin(out.scans);
  if (!odometry) return out;
  for (sim::LineFile line(*odometry); line.next();) out.odometry.push_back({line.number(0), line.pose(1)});
  return out;
}

Recording read_carmen(const std::filesystem::path& file) {
  Recording out;
  for (sim::LineFile line(file); line.next();) {
    if (line.words().front() != "FLASER") continue;
    const std::size_t count = line.count(1, kMaxBeams), behind = 2 + count;
    const double t_s = line.number(line.words().size() - 1);
    LaserScan like;
    like.first_angle_rad = static_cast<float>(-kPi / 2);
    like.angle_step_rad = static_cast<float>(kPi / static_cast<double>(count));
    like.range_min_m = 0.05F;
    like.range_max_m = 40.0F;
    add_scan(out, line, t_s, 2, count, like);
    out.reference.push_back({t_s, line.pose(behind)});
    out.odometry.push_back({t_s, line.pose(behind + 3)});
  }
  return out;
}

std::vector<Label> read_labels(const std::filesystem::path& file) {
  std::vector<Label> out;
  sim::LineFile line(file);
  const bool says_who_walks = line.next() && line.words().back() == "walks";
  while (line.next()) {
    const bool walks = !says_who_walks || line.number(line.words().size() - 1) != 0.0;
    out.push_back({line.number(0), {line.number(2), line.number(3)}, walks});
  }
  return out;
}

WheelState WheelsFromPoses::reading(const StampedPose& at) {
  if (wheels_.sequence > 0) {
    const Pose2 step = inverse(last_.pose) * at.pose;
    const double half = 0.5 * step.heading;
    const double chord = norm(step.position()) * (dot(step.position(), direction(half)) < 0.0 ? -1.0 : 1.0);
    const double arc = std::fabs(half) < 1e-6 ? chord : chord * half / sin(half);
    const double spread = half * drive_.track_width_m;
    const double left = (arc - spread) / drive_.wheel_radius_m, right = (arc + spread) / drive_.wheel_radius_m;
    const double dt = at.t_s - last_.t_s;
    wheels_.left_rad += left;
    wheels_.right_rad += right;
    wheels_.left_radps = dt > 0.0 ? left / dt : 0.0;
    wheels_.right_radps = dt > 0.0 ? right / dt : 0.0;
  }
  wheels_.stamp = time_from_seconds(at.t_s);
  wheels_.sequence += 1;
  last_ = at;
  return wheels_;
}

}  // namespace jaywalk::recordings
