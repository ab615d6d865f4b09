#pragma once
#include <string>

namespace jaywalk::exchange {

/// The definition of a ROS 2 message type ("sensor_msgs/msg/LaserScan") and of all types in it, as MCAP's ros2msg wants
/// it. Field names and types are those of ROS 2 Humble. Throws std::out_of_range for a type that is not among them.
[[nodiscard]] std::string ros_schema(const std::string& type);

}  // namespace jaywalk::exchange
