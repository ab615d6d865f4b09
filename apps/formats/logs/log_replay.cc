#include "apps/formats/logs/log_replay.h"

#include <algorithm>
#include <utility>

namespace jaywalk::sim {
namespace {

/// The newest pose that is not younger than `at`, else the first; nothing without odometry.
std::optional<Pose2> pose_at(const std::vector<OdometryPose>& odometry, Time at) {
  if (odometry.empty()) return std::nullopt;
  const auto younger = std::find_if(odometry.begin(), odometry.end(), [&](const auto& o) { return o.stamp > at; });
  return younger == odometry.begin() ? odometry.front().pose : (younger - 1)->pose;
}

}  // namespace

LogReplay::LogReplay(RecordedLog log)
    : log_(std::move(log)),
      trail_(filled_in(wheel_trail(log_.odometry, nominal_drive()))),
      shown_(std::make_unique<TickRecord>()),
      devices_(*shown_) {
  const double rate_hz = log_.laser().rate_hz;
  shown_->scan.sweep = log_.sweep;
  if (rate_hz > 0.0) shown_->scan.period = duration_from_seconds(1.0 / rate_hz);
  shown_->now = start_time();
  sleep_until(start_time());
}

Pose2 LogReplay::start_pose() const noexcept { return pose_at(log_.odometry, start_time()).value_or(Pose2{}); }

std::optional<Pose2> LogReplay::last_pose() const noexcept { return pose_at(log_.odometry, end_time()); }

DriveModel LogReplay::drive() const {
  DriveModel drive = nominal_drive();
  drive.times = report_times(trail_);
  return drive;
}

void LogReplay::sleep_until(Time wake) noexcept {
  const Time now = shown_->now = shown_->input.stamp = std::max(shown_->now, wake);
  const std::size_t seen = scans_seen_;
  while (scans_seen_ < log_.scans.size() && log_.scans[scans_seen_].stamp <= now) ++scans_seen_;
  if (scans_seen_ != seen) show(log_.scans[scans_seen_ - 1]);
  while (wheels_seen_ < trail_.size() && trail_[wheels_seen_].stamp <= now) ++wheels_seen_;
  if (wheels_seen_ > 0) shown_->wheels = trail_[wheels_seen_ - 1];
}

void LogReplay::show(const RecordedScan& recorded) noexcept {
  LaserScan& scan = shown_->scan;
  scan.stamp = recorded.stamp;
  scan.sequence = static_cast<std::uint32_t>(scans_seen_);
  scan.beam_count = recorded.beams;
  scan.first_angle_rad = recorded.first_angle_rad;
  scan.angle_step_rad = recorded.angle_step_rad;
  scan.range_min_m = recorded.range_min_m;
  scan.range_max_m = recorded.range_max_m;
  std::copy_n(log_.range_m.data() + recorded.first_range, recorded.beams, scan.range_m.data());
}

}  // namespace jaywalk::sim
