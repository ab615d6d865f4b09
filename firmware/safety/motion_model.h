#pragma once
#include <cstddef>
#include <cstdint>

#include "firmware/safety/felt_motion.h"
#include "firmware/safety/reasons.h"
#include "firmware/safety/scan_pair.h"
#include "firmware/safety/wheel_proof.h"
#include "hal/types/robot_model.h"

namespace jaywalk {
/// One model of seen, felt and commanded motion (SAFETY 18 and 23): how far the wheels go by what the scans show,
/// against what the robot file says, and how the scanner is turned in its mount, are states with bounds.
///
/// Felt against commanded is FeltMotion's. Each newer scan is matched to one kept at most kMost_m before (ScanPair),
/// and the match held against the most likely motion within the bounds. The logarithm of their likelihoods' ratio is
/// summed up from pair to pair (Page 1954); kEvidence of it contradicts the wheels. For each arc of kBlind_rad the same
/// is done for "stands still" against "moves as the robot does": an arc that stands while the robot drives is blind. A
/// gain that slip could cause is a fault where a Kalman filter finds it so over metres.
///
/// Nothing is told in open ground, nor of the way along bare walls. Thread: the loop's; memory is fixed.
class MotionModel {
 public:
  /// `scanner`: its index in RobotModel::lasers(). Scans of this scanner alone go to judge().
  explicit MotionModel(const RobotModel& model, std::size_t scanner = 0);

  /// Once a tick, with the newest scan and reading, and the command of the tick before: kScanFrozen while the scanner
  /// repeats a scan to the last bit, kMotionMismatch from a contradiction on for kHolds, kWheelsDisobey.
  [[nodiscard]] Reason judge(const LaserScan& scan, const WheelState& wheels, const WheelCommand& sent,
                             Time now) noexcept;

  static constexpr Duration kHolds = std::chrono::milliseconds(500);

 private:
  using Costs = ScanPair::Costs;

  /// False where it tells nothing, as at rest.
  bool look(const LaserScan& scan) noexcept;
  void note_repeats(const LaserScan& scan, const Rolled& rolled) noexcept;
  /// Matches the scan, and adds to what speaks against the wheels.
  void compare(const LaserScan& scan, const Rolled& felt) noexcept;
  [[nodiscard]] ScanPair::Fit best_fit(const LaserScan& scan, const Rolled& felt) const noexcept;
  [[nodiscard]] Pose2 within_bounds(const ScanPair::Fit& fit, const Rolled& felt) const noexcept;
  [[nodiscard]] std::size_t arc() const noexcept;
  [[nodiscard]] double stands_from(std::size_t first) const noexcept;
  [[nodiscard]] bool is_blind() const noexcept;
  void keep(const LaserScan& scan, const Rolled& rolled) noexcept;
  void update_gain(const Rolled& felt) noexcept;
  [[nodiscard]] Pose2 pose_of(const Moved& moved) const noexcept;

  DriveModel drive_;
  double late_m_;  ///< that a wheel may have rolled while its report was late
  FeltMotion felt_motion_;
  ScanPair pair_;
  WheelTravel travel_;
  std::uint32_t scan_seen_ = 0;

  Time kept_stamp_ = kNever;
  Rolled kept_rolled_, felt_before_;
  ScanPair::Fit fit_{};                         ///< of the newest scan to the kept one
  bool fitted_ = false;                         ///< there is one
  double evidence_ = 0.0, evidence_now_ = 0.0;  ///< of the pairs before, and of this one
  Costs blind_{}, blind_now_{};                 ///< likewise, of the arc from each sector on; of each sector
  int times_ = 0;                               ///< scans in a row that had enough of it
  double against_wheels_ = 0.0;  ///< of this pair, by walls alone: any motion's advantage over that of the wheels
  double gain_ = 1.0, gain_var_;
  Time contradicted_ = kNever;
  int repeats_ = 0;
  Rolled at_first_;  ///< of those
  bool frozen_ = false;
};

}  // namespace jaywalk
