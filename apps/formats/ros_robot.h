#pragma once
// Between a ROS 2 robot's messages and what a robot's program reads from a shared ring (drivers/ros).
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "apps/formats/ros_input.h"
#include "drivers/laser/scanner_protocol.h"
#include "drivers/ros/shared_ring.h"
#include "hal/types/robot_model.h"

namespace jaywalk::exchange {

/// Times of a message: its arrival, and its writing as its writer says.
struct Arrival {
  Arrival(Time by_ours, Time by_wall = kNever, Time at_writer = kNever) noexcept  // NOLINT: a time is an arrival
      : ours(by_ours), wall(by_wall), written(at_writer) {}
  Time ours;     ///< by the loop's clock
  Time wall;     ///< by this machine's wall clock; kNever: not known
  Time written;  ///< DDS's source timestamp, by its writer's wall clock; kNever: not known
};

/// Estimator of the time when a message was sent, by our clock: its arrival less its delay.
///
/// The delay is the message's stamp against that of the fastest message. Stamps within kOneClock of our wall clock are
/// of the same clock; the delay is at least their age by it. A message without a stamp has the time of its writing.
class SentTimes {
 public:
  /// Clocks that differ by more are not the same: robots' are synchronised (ROS 2 wants it for tf), or never set.
  static constexpr Duration kOneClock = std::chrono::seconds(10);

  /// Nothing for a message that is no newer than one before, unless by over kOneClock: a clock was set back.
  [[nodiscard]] std::optional<Time> sent(Time stamp, const Arrival& arrival) noexcept;

 private:
  DeviceClock clock_{Duration{1}, std::uint64_t{1} << 62U};
  Time last_ = kNever;
};

/// Scans in the model's beams, resampled where they have others. The sweep is the time_increment's, one period of the
/// model's rate at most.
class ScanFeed {
 public:
  explicit ScanFeed(const LaserModel& laser) noexcept : laser_(laser) {}
  /// Without beams where ranges, angles or limits make no fan. Nothing where it is no newer than one before.
  [[nodiscard]] std::optional<ros::ScanMessage> take(const ScanMessage& scan, const Arrival& arrival);

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
  /// Nothing where a number in it is none, or no robot's, and where it is no newer than one before.
  [[nodiscard]] std::optional<Wheels> take(const OdometryMessage& odometry, const Arrival& arrival) noexcept;

 private:
  DriveModel drive_;
  SentTimes times_;
  std::optional<Pose2> last_;
  std::array<double, 2> turned_rad_{};
};

/// What the wheels' speeds make of the base; nothing beyond what the model's wheels can do.
[[nodiscard]] std::optional<Twist2> twist_of(double left_radps, double right_radps, const DriveModel& drive) noexcept;

/// Filter of the goals on a topic: repeated and late messages are no orders.
///
/// A node may publish its goal again and again: messages of one writer with the same stamp and pose are one order.
/// Messages without a stamp are all orders here; the robot's program recognises repeated ones (SaidGoals). A late
/// message is no order: its goal may be unwanted by now.
class GoalOrders {
 public:
  enum class Heard : std::uint8_t { kOrder, kRepeated, kLate };
  /// Greatest age of an order: a person waits no longer for an answer. Clocks that differ by more make every goal late.
  static constexpr Duration kGood = std::chrono::seconds(2);

  /// Judges a message. `message`: its bytes, with the stamp; `stamp`: of its header, 0: not set; `writer`: identity of
  /// its publisher.
  [[nodiscard]] Heard judge(std::string_view message, Time stamp, std::uint64_t writer, const Arrival& arrival);

 private:
  static constexpr std::size_t kMostWriters = 64;  ///< all are forgotten for one more
  std::map<std::uint64_t, std::string> last_;
};

}  // namespace jaywalk::exchange
