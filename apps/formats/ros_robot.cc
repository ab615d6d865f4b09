#include "apps/formats/ros_robot.h"

#include <algorithm>
#include <cmath>

#include "apps/formats/logs/recorded_log.h"
#include "hal/types/trig.h"

namespace jaywalk::exchange {
namespace {

constexpr double kFarthest_m = 1e6, kFastest = 100.0;  // of a robot: m, m/s and rad/s
constexpr float kFarthestRange_m = 1000.0F;
constexpr std::size_t kMostRanges = 1U << 16U;

bool is_fan(const ScanMessage& scan) {
  const auto is_angle = [](float rad) { return std::fabs(rad) <= 10.0F; };  // false for NaN
  return scan.range_m.size() >= kLeastBeams && scan.range_m.size() <= kMostRanges && is_angle(scan.first_angle_rad) &&
         is_angle(scan.angle_step_rad) && scan.angle_step_rad != 0.0F && !std::isnan(scan.range_min_m) &&
         scan.range_max_m > std::max(scan.range_min_m, 0.0F);
}

Duration sweep_of(const ScanMessage& scan, Duration period) {
  const double sweep_s = static_cast<double>(scan.beam_step_s) * static_cast<double>(scan.range_m.size() - 1);
  if (!(sweep_s > 0.0)) return Duration{0};
  return sweep_s < to_seconds(period) ? duration_from_seconds(sweep_s) : period;
}

std::uint32_t angle_count(double turned_rad) {
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::llround(turned_rad / ros::kAngle_rad)));
}

/// Age of a stamp by the wall clock, at least 0; 0 where a time is not set or they are of different clocks.
Duration age_on_wall(Time stamp, Time wall) {
  const bool are_set = stamp > Time{} && wall > Time{};
  const Duration old = are_set ? wall - stamp : Duration{0};
  return old < SentTimes::kOneClock ? std::max(old, Duration{0}) : Duration{0};
}

bool is_far_from(Time stamp, Time wall) {
  if (stamp <= Time{} || wall <= Time{}) return false;
  return stamp > wall + GoalOrders::kGood || stamp < wall - GoalOrders::kGood;
}

}  // namespace

std::optional<Time> SentTimes::sent(Time stamp, const Arrival& arrival) noexcept {
  if (stamp <= Time{}) stamp = arrival.written;
  if (stamp <= Time{}) return arrival.ours;
  if (stamp <= last_ && last_ - stamp < kOneClock) return std::nullopt;
  if (stamp <= last_) clock_.forget();
  last_ = stamp;
  const Duration delay = clock_.delay(static_cast<std::uint64_t>(stamp.time_since_epoch().count()), arrival.ours);
  return arrival.ours - std::max({delay, age_on_wall(stamp, arrival.wall), age_on_wall(arrival.written, arrival.wall)});
}

std::optional<ros::ScanMessage> ScanFeed::take(const ScanMessage& scan, const Arrival& arrival) {
  ros::ScanMessage fitted;
  if (!is_fan(scan)) return fitted;
  const std::optional<Time> sent = times_.sent(scan.stamp, arrival);
  if (!sent) return std::nullopt;
  const Duration period = duration_from_seconds(1.0 / laser_.rate_hz), sweep = sweep_of(scan, period);
  const sim::BeamAngles from{static_cast<double>(scan.first_angle_rad), static_cast<double>(scan.angle_step_rad),
                             scan.range_m.size()};
  const sim::BeamAngles to{-0.5 * laser_.fov_rad, laser_.fov_rad / (laser_.beams - 1.0), laser_.beams};
  sim::resample(from, scan.range_m, to, std::span(fitted.range_m).first(laser_.beams));
  fitted.beam_count = laser_.beams;
  fitted.first_angle_rad = static_cast<float>(to.first_rad);
  fitted.angle_step_rad = static_cast<float>(to.step_rad);
  fitted.range_min_m = std::max(scan.range_min_m, 0.0F);
  fitted.range_max_m = scan.range_max_m <= kFarthestRange_m ? scan.range_max_m : static_cast<float>(laser_.range_max_m);
  fitted.stamp_ns = (*sent - sweep).time_since_epoch().count();
  fitted.sweep_ns = sweep.count();
  fitted.period_ns = period.count();
  return fitted;
}

std::optional<OdometryFeed::Wheels> OdometryFeed::take(const OdometryMessage& odometry,
                                                       const Arrival& arrival) noexcept {
  const Pose2& pose = odometry.pose;
  const Twist2& twist = odometry.twist;
  const auto within = [](double value, double most) { return std::fabs(value) <= most; };  // false for NaN
  if (!within(pose.x, kFarthest_m) || !within(pose.y, kFarthest_m) || !within(pose.heading, 2.0 * kPi) ||
      !within(twist.v_mps, kFastest) || !within(twist.w_radps, kFastest))
    return std::nullopt;
  const std::optional<Time> sent = times_.sent(odometry.stamp, arrival);
  if (!sent) return std::nullopt;
  const double turned_rad = last_ ? wrap_angle(pose.heading - last_->heading) : 0.0;
  const double middle_rad = pose.heading - 0.5 * turned_rad;
  const double way_m = last_ ? (pose.x - last_->x) * cos(middle_rad) + (pose.y - last_->y) * sin(middle_rad) : 0.0;
  last_ = pose;
  Wheels out{.stamp = *sent, .wheels = {}};
  for (std::size_t k = 0; k < 2; ++k) {
    const double arm_m = (k == 0 ? -0.5 : 0.5) * drive_.track_width_m;
    turned_rad_[k] += (way_m + arm_m * turned_rad) / drive_.wheel_radius_m;
    const double speed_radps = (twist.v_mps + arm_m * twist.w_radps) / drive_.wheel_radius_m;
    out.wheels[k] = {static_cast<float>(speed_radps), angle_count(turned_rad_[k])};
  }
  return out;
}

std::optional<Twist2> twist_of(double left_radps, double right_radps, const DriveModel& drive) noexcept {
  const double most_radps = drive.max_wheel_speed_radps * 1.001;  // floats on the way
  if (!(std::fabs(left_radps) <= most_radps && std::fabs(right_radps) <= most_radps)) return std::nullopt;
  return Twist2{0.5 * (left_radps + right_radps) * drive.wheel_radius_m,
                (right_radps - left_radps) * drive.wheel_radius_m / drive.track_width_m};
}

GoalOrders::Heard GoalOrders::judge(std::string_view message, Time stamp, std::uint64_t writer,
                                    const Arrival& arrival) {
  if (last_.size() == kMostWriters && !last_.contains(writer)) last_.clear();
  std::string& last = last_[writer];
  if (stamp > Time{} && last == message) return Heard::kRepeated;
  last = message;
  const bool late = is_far_from(stamp, arrival.wall) || is_far_from(arrival.written, arrival.wall);
  return late ? Heard::kLate : Heard::kOrder;
}

}  // namespace jaywalk::exchange
