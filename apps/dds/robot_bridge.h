#pragma once
// Bridge between a ROS 2 robot's devices on DDS and the shared rings of the robot's program.
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "apps/dds/dds_topics.h"
#include "apps/formats/ros_robot.h"
#include "drivers/ros/shared_ring.h"
#include "firmware/robot/realtime.h"
#include "firmware/robot/robot_file.h"

namespace jaywalk::dds {
/// The ring that a robot's program made under a path, found again when another run has made it anew. Thread: one.
class RingHolder {
 public:
  RingHolder(std::filesystem::path path, const ros::SharedRing::Shape& shape) : path_(std::move(path)), shape_(shape) {}

  /// Null while no program has one there. Looks at the path every 50 ms.
  [[nodiscard]] ros::SharedRing* at(Time now) {
    constexpr Duration kLook = std::chrono::milliseconds(50);
    if (looked_ != kNever && now - looked_ < kLook) return ring_.get();
    looked_ = now;
    if (!ring_ || !ring_->is_current()) ring_ = ros::SharedRing::find(path_, shape_);
    return ring_.get();
  }

 private:
  std::filesystem::path path_;
  ros::SharedRing::Shape shape_;
  std::unique_ptr<ros::SharedRing> ring_;
  Time looked_ = kNever;
};

/// Passes on what the robot file's [laser] and [drive] of kind dds name. Two publishers of one topic, and a message
/// that holds no sense, are told and not passed on: the robot's program sees a device that says nothing, and stops.
///
/// Commands are passed on as they come; 100 ms after the last one, and at once when the program's guard raises the
/// alarm, zero is commanded, for a second, and then nothing.
class RobotBridge {
 public:
  /// Throws StartupError where the file names no ROS 2 device, or DDS finds no network.
  RobotBridge(const RobotFile& robot, std::uint32_t domain);
  ~RobotBridge();
  RobotBridge(const RobotBridge&) = delete;
  RobotBridge& operator=(const RobotBridge&) = delete;

  /// What comes from the robot within `most`. Thread: one.
  void pass_in(std::chrono::milliseconds most);
  /// What the program commands within `most`. Thread: another one.
  void pass_out(std::chrono::milliseconds most);
  /// Commands zero, at the end.
  void stop();
  /// Before the threads begin; used while this lives.
  [[nodiscard]] PoseReader poses() const { return PoseReader(participant_); }

 private:
  void add_laser(const LaserWiring& wiring);
  void add_base(const ros::BaseSetup& base);
  void attach(dds_entity_t reader);
  void pass_scans();
  void pass_odometry();
  void watch_commands();
  void send(Time stamp, const CanFrame& frame);
  void obey(const ros::BaseMessage& order);
  void publish(const Twist2& twist);
  void keep_stopped(Time now);
  [[nodiscard]] bool is_alone(dds_entity_t reader, const std::string& topic);
  /// The robot's program sees how old it is; a person is told why.
  void tell_late(const std::string& topic, Time sent, Time now);
  void complain(const std::string& what);

  RobotFile robot_;
  SteadyClock clock_;
  dds_entity_t participant_, waits_;
  dds_entity_t scans_ = 0, odometry_ = 0, others_commands_ = 0, commands_ = 0;  ///< 0: none
  exchange::ScanFeed scan_feed_;
  exchange::OdometryFeed odometry_feed_;
  std::optional<RingHolder> scan_ring_, state_ring_, order_ring_;
  std::map<std::string, std::uint64_t> complaints_;
  std::optional<float> left_radps_;  ///< left half of an order, until the right half comes
  Time ordered_ = kNever, zero_sent_ = kNever;
  std::uint64_t alarms_ = 0;
};

}  // namespace jaywalk::dds
