#include "apps/view/joint_states.h"

#include "apps/formats/ros_topics.h"
#include "apps/formats/wire_reader.h"

namespace jaywalk::view {

FoxgloveChannel joint_channel() {
  // Another type that has a header and no other message in it brings the header's definition.
  const std::string like = exchange::ros_schema("sensor_msgs/msg/CompressedImage");
  return {"/joint_states", "sensor_msgs/msg/JointState",
          "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n" +
              like.substr(like.find("===="))};
}

std::string joint_states(const WheelState& wheels, Time now) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const std::int64_t ns = now.time_since_epoch().count();
  exchange::CdrWriter out;
  out.i32(ns / kSecond).u32(static_cast<std::size_t>(ns % kSecond)).text("");
  out.u32(2).text("left_wheel_joint").text("right_wheel_joint");
  out.u32(2).f64(wheels.left_rad).f64(wheels.right_rad);
  out.u32(2).f64(wheels.left_radps).f64(wheels.right_radps).u32(0);
  return out.message();
}

}  // namespace jaywalk::view
