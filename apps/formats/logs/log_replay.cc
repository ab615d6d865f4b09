#include "apps/formats/logs/log_replay.h"

#include <algorithm>
#include <utility>

namespace jaywalk::sim {
namespace {

class ReplayClock final : public Clock {
 public:
  explicit ReplayClock(Time start) : now_(start) {}
  Time now() noexcept override { return now_; }
  void sleep_until(Time wake) noexcept override { now_ = std::max(now_, wake); }

 private:
  Time now_;
};

class ReplayLaser final : public LaserScanner {
 public:
  ReplayLaser(const RecordedLog& log, Clock& clock) : log_(log), clock_(clock) {
    const double rate_hz = log.laser().rate_hz;
    scan_.sweep = log.sweep;
    if (rate_hz > 0.0) scan_.period = duration_from_seconds(1.0 / rate_hz);
  }
  const LaserScan& latest() noexcept override {
    const Time now = clock_.now();
    const std::size_t shown = seen_;
    while (seen_ < log_.scans.size() && log_.scans[seen_].stamp <= now) ++seen_;
    if (seen_ != shown) show(log_.scans[seen_ - 1]);
    return scan_;
  }

 private:
  void show(const RecordedScan& recorded) noexcept {
    scan_.stamp = recorded.stamp;
    scan_.sequence = static_cast<std::uint32_t>(seen_);
    scan_.beam_count = recorded.beams;
    scan_.first_angle_rad = recorded.first_angle_rad;
    scan_.angle_step_rad = recorded.angle_step_rad;
    scan_.range_min_m = recorded.range_min_m;
    scan_.range_max_m = recorded.range_max_m;
    std::copy_n(log_.range_m.data() + recorded.first_range, recorded.beams, scan_.range_m.data());
  }

  const RecordedLog& log_;
  Clock& clock_;
  LaserScan scan_;
  std::size_t seen_ = 0;  ///< scans whose time has come
};

class ReplayDrive final : public DriveBase {
 public:
  ReplayDrive(const std::vector<OdometryPose>& odometry, Clock& clock)
      : trail_(filled_in(wheel_trail(odometry, nominal_drive()))), clock_(clock) {}
  WheelState latest() noexcept override {
    const Time now = clock_.now();
    while (seen_ < trail_.size() && trail_[seen_].stamp <= now) ++seen_;
    return seen_ == 0 ? WheelState{} : trail_[seen_ - 1];
  }
  void command(const WheelCommand& /*ignored*/) noexcept override {}
  [[nodiscard]] const std::vector<WheelState>& trail() const noexcept { return trail_; }

 private:
  std::vector<WheelState> trail_;
  Clock& clock_;
  std::size_t seen_ = 0;
};

class ReplayPanel final : public OperatorPanel {
 public:
  explicit ReplayPanel(Clock& clock) : clock_(clock) {}
  OperatorInput latest() noexcept override {
    input_.stamp = clock_.now();
    return input_;
  }
  void set_goal(Vec2 goal_in_map, double tolerance_m) noexcept {
    input_.has_goal = true;
    input_.goal_in_map = goal_in_map;
    input_.goal_tolerance_m = tolerance_m;
  }

 private:
  Clock& clock_;
  OperatorInput input_;
};

class NoPoseSource final : public PoseSource {
 public:
  const OutsideFix& latest() noexcept override { return none_; }

 private:
  OutsideFix none_;
};

/// The newest pose that is not younger than `at`, else the first; nothing without odometry.
std::optional<Pose2> pose_at(const std::vector<OdometryPose>& odometry, Time at) {
  if (odometry.empty()) return std::nullopt;
  const auto younger = std::find_if(odometry.begin(), odometry.end(), [&](const auto& o) { return o.stamp > at; });
  return younger == odometry.begin() ? odometry.front().pose : (younger - 1)->pose;
}

}  // namespace

struct LogReplay::State {
  RecordedLog log;
  ReplayClock clock{log.scans.front().stamp};
  ReplayLaser laser{log, clock};
  ReplayDrive drive{log.odometry, clock};
  ReplayPanel panel{clock};
  NoPoseSource pose_source;

  explicit State(RecordedLog recorded) : log(std::move(recorded)) {}
};

LogReplay::LogReplay(RecordedLog log) : state_(std::make_unique<State>(std::move(log))) {}
LogReplay::~LogReplay() = default;

Hal LogReplay::hal() noexcept {
  return {state_->laser, state_->drive, state_->panel, state_->pose_source, state_->clock};
}
void LogReplay::set_goal(Vec2 goal_in_map, double tolerance_m) noexcept {
  state_->panel.set_goal(goal_in_map, tolerance_m);
}
bool LogReplay::ended() const noexcept { return state_->clock.now() >= end_time(); }
Time LogReplay::start_time() const noexcept { return state_->log.scans.front().stamp; }
Time LogReplay::end_time() const noexcept { return state_->log.scans.back().stamp; }
Pose2 LogReplay::start_pose() const noexcept { return pose_at(state_->log.odometry, start_time()).value_or(Pose2{}); }
std::optional<Pose2> LogReplay::last_pose() const noexcept { return pose_at(state_->log.odometry, end_time()); }
DriveModel LogReplay::drive() const {
  DriveModel drive = nominal_drive();
  drive.times = report_times(state_->drive.trail());
  return drive;
}
const RecordedLog& LogReplay::log() const noexcept { return state_->log; }

}  // namespace jaywalk::sim
