#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"

namespace jaywalk {

/// Raindrops, snow, dust: returns that neither neighbours nor earlier scans repeat, and which are therefore no
/// obstacle.
///
/// A body of 2 cm or more is believed at once, by the beams that it fills; the stop zone's 70 mm always are (SAFETY 8).
/// What is thinner is believed with the third scan that has it at the same place in the world, by the wheels' motion.
/// Until then its range is told with a minus sign: it proves nothing, and a recording keeps it.
class LoneReturns {
 public:
  explicit LoneReturns(const RobotModel& model);

  /// The wheels' newest reading; once a tick, before the scans.
  void follow(const WheelState& wheels) noexcept;
  /// Marks the lone returns of one scanner's newest scan. Cost: some ten steps for each beam of a new scan.
  void strike_out(LaserScan& scan) noexcept;

 private:
  static constexpr std::uint8_t kBelieved = 3;  ///< scans

  /// A scan with its returns, and how often each was seen; 0: no return.
  struct Look {
    LaserScan scan;
    std::array<std::uint8_t, kMaxBeams> times{};
    Pose2 odom_from_laser;
  };
  struct Looks {
    Look now, before;
  };

  [[nodiscard]] Pose2 robot_at(Time stamp) const noexcept;
  static void judge(Looks& looks) noexcept;

  DriveModel drive_;
  std::vector<Pose2> mounts_;
  std::vector<Looks> looks_;  ///< of each scanner
  WheelState wheels_;
  Pose2 odom_from_robot_;
};

}  // namespace jaywalk
