#pragma once
// A robot that wanders through a room under the supervisor alone, and a fault of scanner, mount or wheels under way.
#include <deque>
#include <utility>

#include "firmware/safety/supervisor.h"
#include "tests/safety/trial_room.h"

namespace jaywalk::trials {

enum class Fault {
  kNone,
  kNearlyFrozen,   ///< the last scan again, one beam changed by 0 to 6 mm
  kJitterFrozen,   ///< the last scan again with 1 to 8 mm of noise on every beam
  kSectorFrozen,   ///< the same within 60 to 120 degrees
  kMountTurned,    ///< by 15 to 150 degrees at once
  kMountTurning,   ///< by as much at 10 to 60 degrees a second
  kWheelsFar,      ///< 1.3 to 2 times as far as the file says
  kWheelsShort,    ///< 0.5 to 0.75 times
  kRangesFar,      ///< 1.25 to 2 times too long
  kRangesShort,    ///< 0.5 to 0.8 times
  kCountersStuck,  ///< both wheels' angles stand, the speeds go on
  kCounterStuck    ///< one wheel's
};

/// A robot whose base reports as it states, and of drives that were just set up.
struct Base {
  double report_every_s = 0.01;
  DriveTimes times{};
  bool stamped_as_read = true;  ///< else as it comes, which is up to times.late_s later
  bool proves_wheels = false;
  double wheels_go = 1.0;  ///< so many times as far as they say, from the start
};

/// Before anything is tried: robot, scanner, floor.
struct Setting {
  RobotModel model;
  double speed_mps, noise_m, noise_per_m, slip_mean, slip_std, late_s;
  int people;
};

inline Setting random_setting(Engine& engine) {
  Setting setting{.model = uniform(engine, 0.0, 1.0) < 0.5 ? p3dx() : wheelchair(),
                  .speed_mps = uniform(engine, 0.25, 0.6),
                  .noise_m = uniform(engine, 0.003, 0.02),
                  .noise_per_m = uniform(engine, 0.0, 0.003),
                  .slip_mean = uniform(engine, 0.0, 0.06),
                  .slip_std = uniform(engine, 0.0, 0.03),
                  .late_s = uniform(engine, 0.005, 0.04),
                  .people = static_cast<int>(uniform(engine, -2.0, 6.0))};
  LaserModel& laser = setting.model.laser;
  constexpr double kFov_deg[3] = {180.0, 270.0, 360.0};
  const int kind = static_cast<int>(uniform(engine, 0.0, 3.0));
  laser.fov_rad = kFov_deg[kind] / 180.0 * kPi * (kind == 2 ? 0.9975 : 1.0);
  laser.beams = static_cast<std::uint32_t>(kFov_deg[kind] * uniform(engine, 1.0, 3.0)) + 1;
  laser.rate_hz = uniform(engine, 10.0, 25.0);
  return setting;
}

class TrialRobot {
 public:
  TrialRobot(std::uint64_t seed, Fault fault, double strikes_s, const Base& base = {})
      : engine_(seed),
        fault_(fault),
        strikes_s_(strikes_s),
        base_(base),
        setting_(with(random_setting(engine_), base)),
        room_(engine_, std::max(setting_.people, 0)),
        supervisor_({.model = setting_.model, .judges_motion = true, .proves_wheels = base.proves_wheels}) {
    pose_.heading = uniform(engine_, -kPi, kPi);
    input_.has_goal = true;
    draw_fault();
  }

  /// 20 ms.
  void tick() {
    for (int k = 0; k < 10; ++k) move();
    const Verdict verdict =
        supervisor_.judge(wanted_, {delivered_, wheels_, input_, time_from_seconds(now_s_), time_from_seconds(now_s_),
                                    MeasuredLatency{}, false, std::numeric_limits<double>::infinity(), sent_});
    reasons_ = verdict.reasons;
    const Twist2 permitted = verdict.permitted;
    const double half = 0.5 * setting_.model.drive.track_width_m, radius = setting_.model.drive.wheel_radius_m;
    sent_ = {time_from_seconds(now_s_), (permitted.v_mps - half * permitted.w_radps) / radius,
             (permitted.v_mps + half * permitted.w_radps) / radius};
    wander(verdict);
  }

  [[nodiscard]] double now_s() const { return now_s_; }
  [[nodiscard]] bool struck() const { return fault_ != Fault::kNone && now_s_ > strikes_s_; }
  [[nodiscard]] bool accused() const {
    return has(reasons_, Reason::kMotionMismatch | Reason::kWheelsDisobey | Reason::kScanFrozen);
  }
  [[nodiscard]] Reason reasons() const { return reasons_; }
  /// What really moves.
  [[nodiscard]] double speed_mps() const { return std::fabs(truth_.v_mps); }
  /// The faster wheel's rim, as it says.
  [[nodiscard]] double wheel_mps() const { return std::max(std::fabs(left_mps_), std::fabs(right_mps_)); }
  /// Whether the motion of this tick shows the fault: faster than 0.15 m/s (or 0.3 rad/s, where turning shows it), and
  /// where ranges are frozen once a third of those that are stuck is off by 5 cm.
  [[nodiscard]] bool shows() const {
    if (!struck()) return false;
    const bool drives = std::fabs(truth_.v_mps) > 0.15, turns = std::fabs(truth_.w_radps) > 0.3;
    if (frozen()) return (drives || turns) && frozen_off_ > 1.0 / 3.0;
    const bool only_way = fault_ == Fault::kMountTurned || fault_ == Fault::kMountTurning ||
                          fault_ == Fault::kRangesFar || fault_ == Fault::kRangesShort;
    if (fault_ == Fault::kMountTurning && std::fabs(mount_turned()) < 15.0 / 180.0 * kPi) return false;
    if (fault_ == Fault::kCounterStuck) return std::fabs(right_mps_) > 0.15;
    if (fault_ == Fault::kCountersStuck) return wheel_mps() > 0.15;
    return drives || (turns && !only_way);
  }

 private:
  [[nodiscard]] static Setting with(Setting setting, const Base& base) {
    setting.model.drive.times = base.times;
    return setting;
  }
  [[nodiscard]] bool frozen() const {
    return fault_ == Fault::kNearlyFrozen || fault_ == Fault::kJitterFrozen || fault_ == Fault::kSectorFrozen;
  }
  void draw_fault() {
    const double side = uniform(engine_, 0.0, 1.0) < 0.5 ? -1.0 : 1.0;
    turned_ = side * uniform(engine_, 15.0, 150.0) / 180.0 * kPi;
    turns_radps_ = uniform(engine_, 10.0, 60.0) / 180.0 * kPi;
    switch (fault_) {
      case Fault::kWheelsFar: gain_ = uniform(engine_, 1.3, 2.0); break;
      case Fault::kWheelsShort: gain_ = uniform(engine_, 0.5, 0.75); break;
      case Fault::kRangesFar: gain_ = uniform(engine_, 1.25, 2.0); break;
      case Fault::kRangesShort: gain_ = uniform(engine_, 0.5, 0.8); break;
      default: break;
    }
    const bool far = fault_ == Fault::kWheelsFar || fault_ == Fault::kRangesFar;
    if (far) gain_ /= 1.0 - setting_.slip_mean;  // slip apart, which would hide some of it
    jitter_m_ = fault_ == Fault::kNearlyFrozen ? 0.0 : uniform(engine_, 0.001, 0.008);
    if (fault_ == Fault::kSectorFrozen && uniform(engine_, 0.0, 1.0) < 0.4) jitter_m_ = 0.0;
    const double width = uniform(engine_, 60.0, 120.0) / 180.0 * kPi;
    const double centre = uniform(engine_, -1.0, 1.0) * kPi / 4.0;
    stuck_from_ = centre - 0.5 * width, stuck_to_ = centre + 0.5 * width;
    if (fault_ != Fault::kSectorFrozen) stuck_from_ = -7.0, stuck_to_ = 7.0;
  }
  [[nodiscard]] double normal() { return normal_(engine_); }
  [[nodiscard]] double mount_turned() const {
    if (!struck()) return 0.0;
    if (fault_ == Fault::kMountTurned) return turned_;
    const double most = std::fabs(turned_), by = std::min(most, turns_radps_ * (now_s_ - strikes_s_));
    return fault_ == Fault::kMountTurning ? std::copysign(by, turned_) : 0.0;
  }

  /// Two milliseconds: motors with a lag, wheels that slip, people, devices.
  void move() {
    constexpr double kStep_s = 0.002;
    now_s_ += kStep_s;
    const double radius = setting_.model.drive.wheel_radius_m, track = setting_.model.drive.track_width_m;
    const auto follow = [&](double& speed, double wanted) {
      speed += std::clamp((wanted - speed) / 0.05, -1.5, 1.5) * kStep_s;
    };
    follow(left_mps_, radius * sent_.left_radps);
    follow(right_mps_, radius * sent_.right_radps);
    const double kept = std::exp(-kStep_s), fresh = setting_.slip_std * std::sqrt(1.0 - kept * kept);
    left_slip_ = kept * left_slip_ + fresh * normal();
    right_slip_ = kept * right_slip_ + fresh * normal();
    const bool geared = struck() && (fault_ == Fault::kWheelsFar || fault_ == Fault::kWheelsShort);
    const double gain = base_.wheels_go * (geared ? gain_ : 1.0) * (1.0 - setting_.slip_mean);
    const double left = left_mps_ * gain * (1.0 - left_slip_), right = right_mps_ * gain * (1.0 - right_slip_);
    truth_ = {0.5 * (left + right), (right - left) / track};
    const Vec2 way = direction(pose_.heading + 0.5 * truth_.w_radps * kStep_s) * (truth_.v_mps * kStep_s);
    pose_ = {pose_.x + way.x, pose_.y + way.y, pose_.heading + truth_.w_radps * kStep_s};
    room_.move(kStep_s, pose_.position());
    left_rad_ += left_mps_ * kStep_s / radius;
    right_rad_ += right_mps_ * kStep_s / radius;
    if (++steps_ % std::lround(base_.report_every_s / kStep_s) == 0) read_wheels();
    for (; !reports_.empty() && reports_.front().first <= now_s_; reports_.pop_front())
      wheels_ = reports_.front().second;
    if (now_s_ >= next_scan_s_) look();
    if (measured_.sequence != delivered_.sequence && now_s_ >= to_seconds(measured_.stamp) + setting_.late_s)
      delivered_ = measured_;
  }
  void read_wheels() {
    const double radius = setting_.model.drive.wheel_radius_m;
    const bool left_stuck = struck() && fault_ == Fault::kCountersStuck;
    const bool right_stuck = left_stuck || (struck() && fault_ == Fault::kCounterStuck);
    double comes_s = now_s_;
    if (base_.times.late_s > 0.0) comes_s += uniform(engine_, 0.0, base_.times.late_s);
    if (!reports_.empty()) comes_s = std::max(comes_s, reports_.back().first);
    read_.stamp = time_from_seconds(base_.stamped_as_read ? now_s_ : comes_s);
    ++read_.sequence;
    if (!left_stuck) read_.left_rad = left_rad_;
    if (!right_stuck) read_.right_rad = right_rad_;
    read_.left_radps = left_mps_ / radius;
    read_.right_radps = right_mps_ / radius;
    reports_.emplace_back(comes_s, read_);
  }
  void look() {
    next_scan_s_ = now_s_ + 1.0 / setting_.model.laser.rate_hz;
    Pose2 mount = setting_.model.laser.robot_from_laser;
    mount.heading += mount_turned();
    ++measured_.sequence;
    sweep(room_, pose_ * mount, setting_.model.laser, measured_);
    measured_.stamp = time_from_seconds(now_s_);
    const bool scaled = struck() && (fault_ == Fault::kRangesFar || fault_ == Fault::kRangesShort);
    for (std::size_t k = 0; k < measured_.beam_count; ++k) {
      float& range = measured_.range_m[k];
      if (!std::isfinite(range)) continue;
      const double noisy = range + (setting_.noise_m + setting_.noise_per_m * range) * normal();
      range = static_cast<float>(std::floor((scaled ? gain_ : 1.0) * noisy * 1000.0 + 0.5) / 1000.0);
    }
    if (struck() && frozen())
      stick();
    else
      before_ = measured_;
  }
  void stick() {
    const auto shaken = static_cast<std::size_t>(uniform(engine_, 0.0, measured_.beam_count - 1.0));
    int stuck = 0, off = 0;
    for (std::size_t k = 0; k < measured_.beam_count; ++k) {
      const double angle = measured_.angle_rad(k) + setting_.model.laser.robot_from_laser.heading;
      if (angle < stuck_from_ || angle > stuck_to_ || !std::isfinite(measured_.range_m[k])) continue;
      ++stuck;
      off += std::fabs(measured_.range_m[k] - before_.range_m[k]) > 0.05F ? 1 : 0;
      double shown = before_.range_m[k] + jitter_m_ * normal();
      if (k == shaken && jitter_m_ == 0.0) shown += 0.006 * uniform(engine_, 0.0, 1.0);
      measured_.range_m[k] = static_cast<float>(std::floor(shown * 1000.0 + 0.5) / 1000.0);
    }
    frozen_off_ = stuck == 0 ? 0.0 : static_cast<double>(off) / stuck;
  }
  /// On, in bends, and round where it is held up.
  void wander(const Verdict& verdict) {
    const bool held_up = std::fabs(verdict.permitted.v_mps) < 0.12 && wanted_.v_mps > 0.0 && now_s_ > 1.5;
    if (held_up && now_s_ >= until_s_) {
      target_ = {0.0, uniform(engine_, 0.0, 1.0) < 0.5 ? -0.8 : 0.8};
      until_s_ = now_s_ + uniform(engine_, 1.0, 3.0);
    } else if (now_s_ >= until_s_) {
      target_ = {setting_.speed_mps, uniform(engine_, -0.4, 0.4)};
      until_s_ = now_s_ + uniform(engine_, 0.7, 3.0);
    }
    wanted_.v_mps += std::clamp(target_.v_mps - wanted_.v_mps, -0.016, 0.01);
    wanted_.w_radps += std::clamp(target_.w_radps - wanted_.w_radps, -0.04, 0.04);
  }

  Engine engine_;
  std::normal_distribution<double> normal_{0.0, 1.0};
  Fault fault_;
  double strikes_s_;
  Base base_;
  Setting setting_;
  Room room_;
  Supervisor supervisor_;
  OperatorInput input_;
  Pose2 pose_;
  Twist2 truth_, wanted_, target_;
  double now_s_ = 1.0, next_scan_s_ = 1.0, until_s_ = 0.0;
  double left_mps_ = 0.0, right_mps_ = 0.0, left_rad_ = 0.0, right_rad_ = 0.0;
  double left_slip_ = 0.0, right_slip_ = 0.0;
  int steps_ = 0;
  double gain_ = 1.0, turned_ = 0.0, turns_radps_ = 0.0, jitter_m_ = 0.0, stuck_from_ = 0.0, stuck_to_ = 0.0;
  double frozen_off_ = 0.0;
  LaserScan measured_, delivered_, before_;
  WheelState read_, wheels_;
  std::deque<std::pair<double, WheelState>> reports_;  ///< and when they come
  WheelCommand sent_;
  Reason reasons_ = Reason::kNone;
};

}  // namespace jaywalk::trials
