#pragma once
#include <cstdint>

#include "firmware/safety/scan_pair.h"
#include "firmware/safety/wheel_travel.h"
#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"

namespace jaywalk {

/// Proof that the wheels go as far as they say, over the first way after arming, by the scans of one scanner.
///
/// Counts, gears and radii that are typed wrong show in nothing else. Until the proof a wheel's rim goes at most
/// kFirst_mps, then kSlow_mps: ten times as far is a walk at most before it is told. The newest scan is matched to the
/// one kept when the wheels stood last (ScanPair); each wheel's way by that match is held against its counter's. Off by
/// more than kOff_m and kOffShare of the way they contradict each other; over kProof_m, and within kAgreeShare, they
/// agree. In open ground, where scans tell nothing of the way, the slow metre is all there is. Thread: the loop's;
/// memory is fixed.
class WheelProof {
 public:
  static constexpr double kFirst_mps = 0.03, kSlow_mps = 0.1;
  static constexpr double kFirst_m = 0.05;  ///< the first speed's way, unless scans tell before
  static constexpr double kProof_m = 0.12, kAgreeShare = 0.25;
  static constexpr double kOff_m = 0.03, kOffShare = 0.3;  ///< slip, and people that walk
  static constexpr double kUnseen_m = 1.0;                 ///< felt way after which there is nothing to wait for

  /// `scanner`: its index in RobotModel::lasers().
  WheelProof(const RobotModel& model, std::size_t scanner);

  /// The drives were set up anew: nothing is proved.
  void begin() noexcept;
  /// Once a tick, with the newest of both. True while they contradict each other.
  [[nodiscard]] bool contradicts(const LaserScan& scan, const WheelState& wheels) noexcept;
  /// They agreed, or the metre is over.
  [[nodiscard]] bool is_over() const noexcept { return over_; }
  /// Fastest speed of a wheel's rim, m/s; +infinity once it is over.
  [[nodiscard]] double most_mps() const noexcept;

 private:
  [[nodiscard]] Rolled rolled(const WheelState& wheels, Time stamp) const noexcept;
  void keep(const LaserScan& scan, const Rolled& rolled) noexcept;
  void match(const LaserScan& scan, const Rolled& felt) noexcept;
  void judge(const Rolled& felt) noexcept;
  [[nodiscard]] Rolled seen() const noexcept;
  [[nodiscard]] double seen_std_m() const noexcept;

  DriveModel drive_;
  ScanPair pair_;
  std::uint32_t scan_seen_ = 0;
  Rolled kept_rolled_, began_rolled_, last_rolled_;
  ScanPair::Fit fit_{};
  Pose2 before_{};         ///< the fit of the scan before
  double evidence_ = 0.0;  ///< natural logarithm of the fit's likelihood over that of the felt way
  bool began_ = false, over_ = false, is_no_faster_ = false;
  int times_against_ = 0, times_for_ = 0;  ///< scans in a row
  double rolled_m_ = 0.0;                  ///< by the faster wheel, since it began
};

}  // namespace jaywalk
