#include "firmware/safety/lone_returns.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace jaywalk {
namespace {

constexpr double kWhole_m = 0.07;        ///< a cylinder that every scan is to show (SAFETY 8)
constexpr double kSlim_m = 0.02;         ///< width of a body that is believed at once; half of its beams may be lost
constexpr double kSameBody_m = 0.07;     ///< ranges of one body differ by so much, and
constexpr double kSameBodyBeams = 10.0;  ///< on a wall that is seen at 6 degrees, by so many times the beams' distance
constexpr double kAlong_m = 0.03;        ///< a range's noise between two scans: two standard deviations of 1 cm each
constexpr double kAside_m = 0.007;       ///< error of odometry between two scans: 5 ms of a stamp at 1.2 m/s
constexpr double kTurn_rad = 0.01;       ///< the same of its heading: 5 ms of a stamp at 1.5 rad/s
constexpr double kLeastApart_m = 1e-4;   ///< least distance between two beams, m: of what stands on the window

double range_of(const LaserScan& scan, std::size_t beam) { return static_cast<double>(scan.range_m[beam]); }

double step_of(const LaserScan& scan) { return std::fabs(static_cast<double>(scan.angle_step_rad)); }

/// Whether the beams about this one show a body of kSlim_m.
bool has_neighbours(const LaserScan& scan, std::size_t beam) {
  const double range = range_of(scan, beam), apart_m = std::max(range * step_of(scan), kLeastApart_m);
  if (kWhole_m < 3.0 * apart_m) return true;  // so far away a cylinder may be one beam
  const double beams = kSlim_m / apart_m;
  const auto needed = static_cast<std::size_t>(std::max(2.0, std::ceil(0.5 * beams)));
  const auto reach = static_cast<std::size_t>(std::max(2.0, beams));
  const std::size_t last = std::min<std::size_t>(beam + reach, scan.beam_count - 1U);
  std::size_t alike = 0;
  for (std::size_t k = beam - std::min(beam, reach); k <= last; ++k)
    alike += scan.is_hit(k) && std::fabs(range_of(scan, k) - range) < kSameBody_m + kSameBodyBeams * apart_m ? 1U : 0U;
  return alike >= needed;
}

}  // namespace

LoneReturns::LoneReturns(const RobotModel& model) : drive_(model.drive) {
  for (const LaserModel& laser : model.lasers()) mounts_.push_back(laser.robot_from_laser);
  looks_.resize(mounts_.size());
}

void LoneReturns::follow(const WheelState& wheels) noexcept {
  const WheelState before = std::exchange(wheels_, wheels);
  if (wheels.sequence == before.sequence) return;
  if (before.sequence == 0 || wheels.sequence < before.sequence) {  // where it was before is not known
    for (Looks& looks : looks_) looks.now.times.fill(0), looks.before.times.fill(0);
    return;
  }
  const double left = (wheels.left_rad - before.left_rad) * drive_.wheel_radius_m,
               right = (wheels.right_rad - before.right_rad) * drive_.wheel_radius_m;
  const double turned = (right - left) / drive_.track_width_m;
  const Vec2 moved = direction(odom_from_robot_.heading + 0.5 * turned) * (0.5 * (left + right));
  odom_from_robot_ = {odom_from_robot_.x + moved.x, odom_from_robot_.y + moved.y,
                      wrap_angle(odom_from_robot_.heading + turned)};
}

/// From the newest reading, by its speeds.
Pose2 LoneReturns::robot_at(Time stamp) const noexcept {
  const double after_s = wheels_.stamp == kNever ? 0.0 : std::clamp(to_seconds(stamp - wheels_.stamp), -0.2, 0.2);
  const double left = wheels_.left_radps * drive_.wheel_radius_m, right = wheels_.right_radps * drive_.wheel_radius_m;
  const double turned = (right - left) / drive_.track_width_m * after_s;
  const Vec2 moved = direction(odom_from_robot_.heading + 0.5 * turned) * (0.5 * (left + right) * after_s);
  return {odom_from_robot_.x + moved.x, odom_from_robot_.y + moved.y, wrap_angle(odom_from_robot_.heading + turned)};
}

void LoneReturns::strike_out(LaserScan& scan) noexcept {
  if (scan.sequence == 0 || scan.beam_count > kMaxBeams) return;
  Looks& looks = looks_[scan.scanner];
  if (scan.sequence != looks.now.scan.sequence) {
    std::swap(looks.now, looks.before);
    looks.now.scan = scan;
    for (std::size_t k = 0; k < scan.beam_count; ++k)  // of a recording: what was struck out
      if (!scan.too_near(k) && scan.range_m[k] < 0.0F) looks.now.scan.range_m[k] = -scan.range_m[k];
    looks.now.odom_from_laser = robot_at(scan.stamp) * mounts_[scan.scanner];
    judge(looks);
  }
  for (std::size_t k = 0; k < scan.beam_count; ++k) {
    const std::uint8_t times = looks.now.times[k];
    if (looks.now.scan.is_hit(k))
      scan.range_m[k] = times > 0 && times < kBelieved ? -looks.now.scan.range_m[k] : looks.now.scan.range_m[k];
  }
}

void LoneReturns::judge(Looks& looks) noexcept {
  Look& now = looks.now;
  const Look& before = looks.before;
  const Transform2 before_from_now(inverse(before.odom_from_laser) * now.odom_from_laser);
  const double step = static_cast<double>(before.scan.angle_step_rad), middle = 0.5 * before.scan.beam_count;
  const double ahead = before.scan.angle_rad(0) + middle * step;
  /// Most times that the last scan had something at that place.
  const auto times_before = [&](Vec2 place) {
    std::uint8_t most = 0;
    const double range = norm(place);
    const double aside = (kAside_m / std::max(range, kAside_m) + kTurn_rad) / std::fabs(step) + 1.0;
    const double at = middle + wrap_angle(jaywalk::atan2(place.y, place.x) - ahead) / step;
    const auto last = static_cast<std::size_t>(std::clamp(at + aside + 1.0, 0.0, 2.0 * middle));
    for (auto k = static_cast<std::size_t>(std::clamp(std::ceil(at - aside), 0.0, 2.0 * middle)); k < last; ++k)
      if (std::fabs(range_of(before.scan, k) - range) < kAlong_m) most = std::max(most, before.times[k]);
    return most;
  };
  const bool has_before = before.scan.sequence != 0 && step != 0.0;
  for (std::size_t k = 0; k < now.scan.beam_count; ++k) {
    now.times[k] = now.scan.is_hit(k) ? kBelieved : std::uint8_t{0};
    if (now.times[k] == 0 || has_neighbours(now.scan, k)) continue;
    const Vec2 place = before_from_now * (direction(now.scan.angle_rad(k)) * range_of(now.scan, k));
    const std::uint8_t before_times = has_before ? times_before(place) : std::uint8_t{0};
    now.times[k] = std::min<std::uint8_t>(kBelieved, static_cast<std::uint8_t>(before_times + 1U));
  }
}

}  // namespace jaywalk
