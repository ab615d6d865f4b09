#pragma once
// Between a ROS 2 robot's messages and what a robot's program reads from a shared ring (drivers/ros).
#include <array>
#include <optional>

#include "apps/formats/ros_input.h"
#include "drivers/laser/device_clock.h"
#include "drivers/ros/ring_messages.h"
#include "hal/types/robot_model.h"

namespace jaywalk::exchange {

/// When a message was sent, by our clock: its arrival minus its extra delay. The message's own stamps give the delay
/// beyond that of the fastest message. Where stamps do not increase (the sender's clock was set back, or never set)
/// the time of arrival is used.
class SentTimes {
 public:
  [[nodiscard]] Time sent(Time stamp, Time arrival) noexcept;

 private:
  DeviceClock clock_{Duration{1}, std::uint64_t{1} << 62U};
  Time last_ = kNever;
};

/// Scans in the model's beams, resampled where they have others. The sweep is the time_increment's, one period of the
/// model's rate at most.
class ScanFeed {
 public:
  explicit ScanFeed(const LaserModel& laser) noexcept : laser_(laser) {}
  /// Without beams where it is no scan of a fan: no or too few ranges, angles or limits that are no numbers.
  [[nodiscard]] ros::ScanMessage take(const ScanMessage& scan, Time arrival);

 private:
  LaserModel laser_;
  SentTimes times_;
};

/// A base's odometry as that of two wheels with the model's radius and track.
class OdometryFeed {
 public:
  struct Wheels {
    Time stamp = kNever;
    std::array<ros::WheelFrame, 2> wheels;  ///< left, right
  };
  explicit OdometryFeed(const DriveModel& drive) noexcept : drive_(drive) {}
  /// Nothing where a number in it is none, or no robot's.
  [[nodiscard]] std::optional<Wheels> take(const OdometryMessage& odometry, Time arrival) noexcept;

 private:
  DriveModel drive_;
  SentTimes times_;
  std::optional<Pose2> last_;
  std::array<double, 2> turned_rad_{};
};

/// What the wheels' speeds make of the base; nothing beyond what the model's wheels can do.
[[nodiscard]] std::optional<Twist2> twist_of(double left_radps, double right_radps, const DriveModel& drive) noexcept;

}  // namespace jaywalk::exchange
