#pragma once
#include <array>
#include <cstdint>

#include "firmware/safety/free_claims.h"
#include "firmware/safety/wheel_proof.h"
#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"

namespace jaywalk {
/// Raindrops, snow, dust: returns that neither neighbours nor earlier scans repeat, and which are therefore no
/// obstacle.
///
/// A body of 2 cm or more is believed at once, by the beams that it fills; the stop zone's 70 mm always are (SAFETY 8).
/// A thinner body is believed with the third scan that has it at the same place in the world, by the wheels' motion.
/// Until then its range is told with a minus sign: it proves nothing, and a recording keeps it.
class LoneReturns {
 public:
  /// Judges a new scan. `now_from_before`: pose of the laser at the scan before, in its frame at this one. Cost: some
  /// ten steps for each beam.
  void take(const LaserScan& scan, const Pose2& now_from_before) noexcept;
  /// Marks the lone returns of the scan that was taken last.
  void strike_out(LaserScan& scan) const noexcept;

 private:
  static constexpr std::uint8_t kBelieved = 3;  ///< scans

  /// A scan with its returns, and how often each was seen; 0: no return.
  struct Look {
    LaserScan scan;
    std::array<std::uint8_t, kMaxBeams> times{};
  };

  /// Most times that the scan before had something at a place in its frame.
  [[nodiscard]] std::uint8_t times_before(Vec2 place) const noexcept;

  Look now_, before_;
};

/// Filter of one scanner's beams before anything uses them: hits on the robot itself, lone returns and doubted free
/// beams prove nothing.
///
/// The wheels tell how the scanner moved between its scans; without them only hits on the robot are taken out. A scan
/// that was filtered before is left as it is, so that recordings replay. Thread: the loop's; memory is fixed.
class BeamFilter {
 public:
  BeamFilter(const RobotModel& model, std::size_t scanner, bool has_wheels = true);

  /// Once a tick, with the scanner's newest scan as it came and the wheels' newest reading.
  void filter(LaserScan& scan, const WheelState& wheels) noexcept;

 private:
  [[nodiscard]] Pose2 now_from_before(Time stamp) noexcept;

  Blanking blanked_;
  Pose2 robot_from_laser_;
  double track_width_m_;
  bool has_wheels_;
  WheelTravel travel_;
  std::uint32_t sequence_ = 0;
  Rolled rolled_;  ///< at the scan before
  bool rolled_known_ = false;
  LoneReturns lone_returns_;
  FreeClaims free_claims_;
};

}  // namespace jaywalk
