#pragma once
// The two wheels as sensor_msgs/JointState, which ROS 2's robot_state_publisher turns a model's wheels by.
#include <string>

#include "apps/view/foxglove_session.h"
#include "hal/types/wheels.h"

namespace jaywalk::view {
/// /joint_states: left_wheel_joint and right_wheel_joint, as most models of two-wheeled bases name them.
[[nodiscard]] FoxgloveChannel joint_channel();
/// Angles (rad) and speeds (rad/s) in CDR; no efforts.
[[nodiscard]] std::string joint_states(const WheelState& wheels, Time now);

}  // namespace jaywalk::view
