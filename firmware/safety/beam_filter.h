#pragma once
#include <cstdint>

#include "firmware/safety/free_claims.h"
#include "firmware/safety/lone_returns.h"
#include "firmware/safety/wheel_travel.h"
#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"

namespace jaywalk {

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
