#include "apps/setup/mount_search.h"

#include <chrono>
#include <cmath>

#include "apps/formats/logs/log_replay.h"
#include "planner/localization/localizer.h"
#include "planner/tracking/tracker.h"

namespace jaywalk {
namespace {

constexpr double kWay_m = 20.0, kFound_rad = 0.02;
constexpr int kTries = 7;
/// The scans and odometry of the first kWay_m.
sim::RecordedLog beginning_of(const sim::RecordedLog& log) {
  sim::RecordedLog part;
  double way_m = 0.0;
  for (const sim::OdometryPose& next : log.odometry) {
    if (!part.odometry.empty()) way_m += distance(part.odometry.back().pose.position(), next.pose.position());
    part.odometry.push_back(next);
    if (way_m > kWay_m) break;
  }
  for (const sim::RecordedScan& scan : log.scans) {
    if (scan.stamp > part.odometry.back().stamp) break;
    part.scans.push_back(scan);
  }
  const std::size_t ranges = part.scans.empty() ? 0 : part.scans.back().first_range + part.scans.back().beams;
  part.range_m.assign(log.range_m.begin(), log.range_m.begin() + static_cast<std::ptrdiff_t>(ranges));
  part.sweep = log.sweep;
  return part;
}

/// By how much the yaw of `part` is still wrong, as far as a life with it tells.
std::optional<double> missing_in(const sim::RecordedLog& part) {
  MountCheck check;
  live_through(part, [&](const LivedTick& tick) {
    check.add(tick.map_from_robot);
    return true;
  });
  return check.slide();
}

constexpr double kEnough_m = 5.0;
// Where it turns more a metre, a laser that stands before the axle, or beside it, swings to the side as well.
constexpr double kStraight_radpm = 0.15;

}  // namespace

void live_through(const sim::RecordedLog& log, const std::function<bool(const LivedTick&)>& visit) {
  constexpr Duration kTick = std::chrono::milliseconds(20);
  sim::LogReplay replay(log);
  Hal hal = replay.hal();
  Localizer localizer({.map_from_robot_at_start = replay.start_pose(),
                       .drive = replay.drive(),
                       .robot_from_laser = log.robot_from_laser});
  Tracker tracker({.robot_from_laser = log.robot_from_laser, .map_centre = replay.start_pose().position()});
  std::uint32_t last_scan = 0;
  for (Time next = hal.clock.now() + kTick; !replay.ended(); next += kTick) {
    const LaserScan& scan = hal.laser.latest();
    const Pose2& now = localizer.update(hal.drive.latest(), scan, {}, tracker.still(), tracker.moving()).map_from_robot;
    if (scan.sequence != last_scan) tracker.update(scan, localizer.map_from_robot_at_scan(), localizer.twist());
    last_scan = scan.sequence;
    if (!visit({next, now, scan.stamp, localizer.map_from_robot_at_scan()})) return;
    hal.clock.sleep_until(next);
  }
}

std::optional<double> found_mount_yaw(const sim::RecordedLog& log) {
  if (log.odometry.empty()) return std::nullopt;
  sim::RecordedLog part = beginning_of(log);
  if (part.scans.empty()) return std::nullopt;
  for (int k = 0; k < kTries; ++k) {
    const std::optional<double> slide = missing_in(part);
    if (!slide) return std::nullopt;
    double& yaw = part.robot_from_laser.heading;
    if (k == 0 && std::fabs(*slide) < MountCheck::kTells_rad) return std::nullopt;
    if (std::fabs(*slide) < kFound_rad) return yaw;
    yaw = wrap_angle(yaw - *slide);
  }
  return std::nullopt;
}

void MountCheck::add(const Pose2& map_from_robot) {
  const Vec2 step = inverse(before_) * map_from_robot.position();
  const double turn = wrap_angle(map_from_robot.heading - before_.heading);
  if (begun_ && std::fabs(turn) < kStraight_radpm * norm(step)) driven_in_robot_ = driven_in_robot_ + step;
  begun_ = true;
  before_ = map_from_robot;
}

std::optional<double> MountCheck::slide() const {
  if (norm(driven_in_robot_) < kEnough_m) return std::nullopt;
  return atan2(driven_in_robot_.y, driven_in_robot_.x);
}

std::optional<double> MountCheck::missing_yaw() const {
  const std::optional<double> slid = slide();
  if (!slid || std::fabs(*slid) <= kTells_rad) return std::nullopt;
  // A laser that looks to the left by some yaw, taken for one that looks ahead, sees the robot slide to the right by
  // it.
  return -*slid;
}

}  // namespace jaywalk
