#pragma once
// What a robot's program and jaywalk_dds tell each other through shared rings. Times are CLOCK_MONOTONIC's.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

#include "drivers/can/can_frame.h"
#include "drivers/ros/shared_ring.h"
#include "hal/types/laser_scan.h"

namespace jaywalk::ros {

/// A sensor_msgs/LaserScan in the beams of the robot's model. One without beams was no scan.
struct ScanMessage {
  std::int64_t stamp_ns = 0;  ///< of the first beam
  std::int64_t sweep_ns = 0, period_ns = 0;
  std::uint32_t beam_count = 0;
  float first_angle_rad = 0.0F, angle_step_rad = 0.0F;
  float range_min_m = 0.0F, range_max_m = 0.0F;
  std::uint32_t reserved = 0;
  std::array<float, kMaxBeams> range_m{};  ///< as ROS has them
};
inline constexpr SharedRing::Shape kScanRing{sizeof(ScanMessage), 8};
static_assert(kScanRing.message_bytes % 8 == 0);

/// One frame of a base that is seen as two motors on a bus.
struct BaseMessage {
  std::int64_t stamp_ns = 0;
  std::uint32_t id = 0;
  std::uint32_t size = 0;
  std::array<std::uint8_t, 8> bytes{};
};
inline constexpr SharedRing::Shape kBaseRing{sizeof(BaseMessage), 256};

/// Left of each pair; the right one's follows.
enum FrameId : std::uint32_t {
  kWheel = 1,         ///< what a wheel does
  kListeners = 3,     ///< how many nodes listen to the commands, in the first byte
  kOtherMaster = 4,   ///< another node commands the base; without bytes
  kWheelOrder = 0x10  ///< what a wheel is to do: its speed; without an angle
};

/// Speed and angle of a wheel: a float in rad/s, and a count that wraps of kAngle_rad.
struct WheelFrame {
  float speed_radps = 0.0F;
  std::uint32_t angle = 0;
};
inline constexpr double kAngle_rad = 1e-4;  ///< 10 um of way

/// Whether a stamp found in a ring can be a time of this run: not in the future, and at most ten seconds old.
[[nodiscard]] inline bool is_recent(std::int64_t stamp_ns, Time now) noexcept {
  constexpr Duration kOldest = std::chrono::seconds(10);
  const std::int64_t now_ns = now.time_since_epoch().count();
  return stamp_ns <= now_ns && stamp_ns >= now_ns - kOldest.count();
}

[[nodiscard]] inline CanFrame to_frame(std::uint32_t id, const WheelFrame& wheel) noexcept {
  return {.id = id, .size = 8, .bytes = std::bit_cast<std::array<std::uint8_t, 8>>(wheel)};
}

/// Nothing where it is no frame of a wheel, or its speed is no number.
[[nodiscard]] inline std::optional<WheelFrame> wheel_in(const CanFrame& frame) noexcept {
  const auto wheel = std::bit_cast<WheelFrame>(frame.bytes);
  if (frame.size != sizeof wheel || !std::isfinite(wheel.speed_radps)) return std::nullopt;
  return wheel;
}

}  // namespace jaywalk::ros
