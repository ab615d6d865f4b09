#pragma once
// Shared memory between the robot's program and jaywalk_dds, and what is said there.
#include <sys/stat.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "drivers/can/can_bus.h"
#include "hal/types/laser_scan.h"
#include "hal/types/time.h"

namespace jaywalk::ros {

/// Messages of one fixed size, one way between two processes of one user, in a file that both have mapped.
///
/// One thread writes and one reads; neither waits for the other, and either may die and come back. The writer
/// overwrites the oldest; each slot says which message it holds, so that the reader sees what was overwritten, torn or
/// damaged and goes on at the newest. It believes nothing else that stands in the file. Memory is taken at start.
class SharedRing {
 public:
  struct Shape {
    std::size_t message_bytes = 0;  ///< a multiple of 8
    std::size_t slots = 0;
  };
  enum class Took : std::uint8_t { kNothing, kMessage, kTorn };

  /// Start-up only: a new file of this user's alone, which goes when this does; one that an earlier process left is
  /// replaced. Throws StartupError where it cannot be made, or something else lies there.
  [[nodiscard]] static std::unique_ptr<SharedRing> make(const std::filesystem::path& path, const Shape& shape);
  /// The file that another process of this user made; none while there is no such file. Begins at what comes next.
  [[nodiscard]] static std::unique_ptr<SharedRing> find(const std::filesystem::path& path, const Shape& shape);
  ~SharedRing();
  SharedRing(const SharedRing&) = delete;
  SharedRing& operator=(const SharedRing&) = delete;

  /// Whether the path still leads to this file.
  [[nodiscard]] bool is_current() const noexcept;

  /// Writer's thread. `message` has the shape's size.
  void write(std::span<const std::byte> message) noexcept;
  /// Reader's thread: the oldest that was not read, into `message` of the shape's size; spoilt where it is torn.
  [[nodiscard]] Took read(std::span<std::byte> message) noexcept;
  /// Reader's thread: forgets what waits.
  void skip() noexcept;
  /// Reader's thread: returns when a message waits, at an alarm, or after `most`.
  void wait(Duration most) const noexcept;
  /// How many messages were overwritten before they were read.
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }

  /// Beside the messages, from any thread of the writer's process: something that is not to wait for its turn.
  void raise_alarm() noexcept;
  [[nodiscard]] std::uint64_t alarms() const noexcept;

 private:
  struct Header;

  SharedRing(std::filesystem::path path, const struct stat& is, const Shape& shape, bool is_maker) noexcept
      : path_(std::move(path)), is_(is), shape_(shape), is_maker_(is_maker) {}
  [[nodiscard]] static std::size_t bytes_of(const Shape& shape) noexcept;
  /// Null where it is no file of this user's alone, of another size, or cannot be mapped.
  [[nodiscard]] static std::unique_ptr<SharedRing> map(const std::filesystem::path& path, int file, const Shape& shape,
                                                       bool is_maker);
  /// The slot's own number, followed by the message.
  [[nodiscard]] std::uint64_t* slot_of(std::uint64_t number) const noexcept;
  void ring_bell() noexcept;

  std::filesystem::path path_;
  struct stat is_;
  Shape shape_;
  bool is_maker_;
  Header* header_ = nullptr;
  std::uint64_t written_ = 0, next_ = 1;  ///< the last one written; the next one to read. From 1
  std::uint64_t lost_ = 0;
};

// What a robot's program and jaywalk_dds tell each other through shared rings. Times are CLOCK_MONOTONIC's.

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
