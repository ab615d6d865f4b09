#pragma once
#include <cstdint>

#include "firmware/safety/scan_pair.h"
#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"

namespace jaywalk {
/// Scans of a robot at rest against the one that its rest began with: whether it stands where its wheels stopped.
///
/// Wheels that stand say nothing of a robot that is lifted, pushed aside or turned by hand (SAFETY 30). Each scan since
/// they stopped is matched to the first (ScanPair). The robot was moved where another place explains the scans and
/// standing does not: by the logarithm of their likelihoods' ratio without the sectors that say most, which people or a
/// door may be. It was moved out of sight where neither explains them: most of what is still in view is not where it
/// stood, and flat surfaces stand where nothing was. What something nearer hides tells nothing. Three scans in a row
/// decide.
///
/// Shorter than a hand and less than a scanner shakes in its mount is no move. The wheels' angles tell rest, not their
/// speeds: the first scan is kept over a silence of the drives, and over counters that restart. Thread: the loop's.
/// Memory is fixed.
class RestWatch {
 public:
  enum class Says : std::uint8_t {
    kNothing,  ///< no new scan, no rest, or too little in view
    kStands,
    kDoubts,  ///< it may have been moved: this scan is not explained by standing
    kMoved
  };

  /// `scanner`: its index in RobotModel::lasers(). Scans of this scanner alone go to judge().
  explicit RestWatch(const RobotModel& model, std::size_t scanner = 0);

  /// Once a tick, with the newest scan and reading.
  [[nodiscard]] Says judge(const LaserScan& scan, const WheelState& wheels) noexcept;
  /// Begins the rest anew with the next scan: the robot's place is known.
  void begin_anew() noexcept;

 private:
  /// Sum of the weights (ScanPair) of the points that two scans could compare, and the share of it that fits.
  struct Agreement {
    double compared = 0.0, explained = 0.0;
  };
  void note(const WheelState& wheels) noexcept;
  void keep(const LaserScan& scan) noexcept;
  [[nodiscard]] Says compare(const LaserScan& scan) noexcept;
  void find(const LaserScan& scan) noexcept;
  /// Agreement of the first scan's points with the newest scan and of the newest one's with the first, summed.
  [[nodiscard]] Agreement agreement(const LaserScan& scan, const Pose2& first_from_now) const noexcept;
  /// True where the found place explains the scans better than the place of rest.
  [[nodiscard]] bool is_likelier(const LaserScan& scan) const noexcept;

  double wheel_radius_m_;
  ScanPair pair_;  ///< of the first scan's points
  ScanPair back_;  ///< of the newest one's
  LaserScan first_;
  bool kept_ = false;
  double kept_weight_ = 0.0;  ///< of its points
  ScanPair::Fit fit_{};       ///< of the newest scan to the kept one
  double noise_m_ = 0.0;      ///< standard deviation of the errors while it stands
  std::uint32_t wheels_seen_ = 0, scan_seen_ = 0;
  Time wheels_stamp_ = kNever, rests_since_ = kNever;
  double left_m_ = 0.0, right_m_ = 0.0;  ///< how far each wheel's rim had rolled when it came to rest
  int doubts_ = 0, changes_ = 0;         ///< scans in a row
};

}  // namespace jaywalk
