#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/safety/scan_pair.h"
#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"

namespace jaywalk {

/// Compares each wheel's feedback with what it was commanded, through a model of the drive (SAFETY 18 and 33).
///
/// A sound drive has obeyed a command after at most DriveTimes::obeyed_within_s(), and changes its speed by at least
/// limits.brake_mps2 until then: its speed lies between bounds that follow the least and the greatest command of that
/// time. What it is outside by more than kOff_mps and kOffShare of the bound is summed up (Page 1954, CUSUM); kFault_m
/// is disobedience. Speeds and ways are the rim's. A wheel that stands though commanded 0.2 m/s is told within 0.5 s.
///
/// A wheel's angle is held against its speed in the same way, up to kApart_m and what the robot at its fastest drives
/// while a report may be late. Every report counts, however long after the one before: times that are told wrong for
/// one of them are told wrong the other way for the next, so that their sum is not. Thread: the loop's.
class FeltMotion {
 public:
  static constexpr double kOff_mps = 0.02;
  static constexpr double kOffShare = 0.15;
  static constexpr double kFault_m = 0.03;  ///< steps of coarse encoders cancel out long before
  static constexpr double kApart_m = 0.03;
  static constexpr double kApartShare = 0.06;  ///< of the way: both are one encoder's, speeds may be filtered

  FeltMotion(const DriveModel& drive, const MotionLimits& limits);

  /// Once a tick, with the command of the tick before and the newest reading. From a drive in trouble, which brakes by
  /// itself, zero is obedience as well.
  [[nodiscard]] bool disobeys(const WheelCommand& command, const WheelState& wheels, Time now) noexcept;

 private:
  /// The commands of the last 0.64 s at 200 Hz; at more the oldest is forgotten early.
  static constexpr std::size_t kMostCommands = 128;
  struct Span {
    double least = 0.0, greatest = 0.0;
  };
  struct Wheel {
    Span may_be;                           ///< m/s
    double off_m = 0.0;                    ///< that it went too far or not far enough, of late
    double ahead_m = 0.0, behind_m = 0.0;  ///< that its angle turned more or less than its speed says, likewise
  };
  struct Sent {
    Time from = kNever;
    double left_mps = 0.0, right_mps = 0.0;
  };

  void keep(const Sent& sent) noexcept;
  [[nodiscard]] Span commanded(double Sent::*wheel, Time now, bool zero_too) const noexcept;
  [[nodiscard]] bool is_off(Wheel& wheel, const Span& commanded, double felt_mps, double step_s) const noexcept;
  void compare(Wheel& wheel, double rolled_m, double felt_mps, double step_s) const noexcept;
  [[nodiscard]] bool contradicts_itself(const WheelState& wheels) noexcept;

  double wheel_radius_m_, ramp_mps2_;
  Duration obeys_within_, oldest_;
  double apart_m_;
  WheelState counted_;
  std::array<Sent, kMostCommands> sent_{};
  std::size_t newest_ = 0;
  Wheel left_, right_;
  Time judged_ = kNever;
  Time zero_until_ = kNever;  ///< zero is obedience as well
};

/// Scans of a robot at rest against the one that its rest began with: whether it stands where its wheels stopped.
///
/// Wheels that stand say nothing of a robot that is lifted, pushed aside or turned by hand (SAFETY 30). Each scan since
/// they stopped is matched to the first (ScanPair). The robot was moved where another place explains the scans and
/// standing does not, without the sectors that say most, which people or a door may be; out of sight where neither
/// does. Three scans in a row decide.
///
/// Angles tell rest, not speeds: the first scan outlasts silent drives and counters that restart. Thread: the loop's.
class RestWatch {
 public:
  enum class Says : std::uint8_t {
    kNothing,  ///< no new scan, no rest, or too little in view
    kStands,
    kDoubts,  ///< it may have been moved: this scan is not explained by standing
    kMoved
  };

  /// `scanner`: its index in RobotModel::lasers(). Scans of this scanner alone go to judge().
  explicit RestWatch(const RobotModel& model, std::size_t scanner = 0);

  /// Once a tick, with the newest scan and reading.
  [[nodiscard]] Says judge(const LaserScan& scan, const WheelState& wheels) noexcept;
  /// Begins the rest anew with the next scan: the robot's place is known.
  void begin_anew() noexcept;

 private:
  /// Sum of the weights (ScanPair) of the points that two scans could compare, and the share of it that fits.
  struct Agreement {
    double compared = 0.0, explained = 0.0;
  };
  void note(const WheelState& wheels) noexcept;
  void keep(const LaserScan& scan) noexcept;
  [[nodiscard]] Says compare(const LaserScan& scan) noexcept;
  void find(const LaserScan& scan) noexcept;
  /// Agreement of the first scan's points with the newest scan and of the newest one's with the first, summed.
  [[nodiscard]] Agreement agreement(const LaserScan& scan, const Pose2& first_from_now) const noexcept;
  [[nodiscard]] bool is_likelier(const LaserScan& scan) const noexcept;

  double wheel_radius_m_;
  ScanPair pair_;  ///< of the first scan's points
  ScanPair back_;  ///< of the newest one's
  LaserScan first_;
  bool kept_ = false;
  double kept_weight_ = 0.0;  ///< of its points
  ScanPair::Fit fit_{};       ///< of the newest scan to the kept one
  double noise_m_ = 0.0;      ///< standard deviation of the errors while it stands
  std::uint32_t wheels_seen_ = 0, scan_seen_ = 0;
  Time wheels_stamp_ = kNever, rests_since_ = kNever;
  double left_m_ = 0.0, right_m_ = 0.0;  ///< how far each wheel's rim had rolled when it came to rest
  int doubts_ = 0, changes_ = 0;         ///< scans in a row
};

}  // namespace jaywalk
