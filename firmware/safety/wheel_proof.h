#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "firmware/safety/scan_pair.h"
#include "hal/types/geometry.h"
#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"

namespace jaywalk {
/// Way of each wheel's rim, m, positive forwards.
struct Rolled {
  double left_m = 0.0, right_m = 0.0;
};
constexpr Rolled operator-(const Rolled& a, const Rolled& b) noexcept {
  return {a.left_m - b.left_m, a.right_m - b.right_m};
}

/// Way of the wheel that went farther, m, 0 or more.
[[nodiscard]] inline double farther_m(const Rolled& way) noexcept {
  return std::max(std::fabs(way.left_m), std::fabs(way.right_m));
}

/// Ring of the wheels' latest readings: the way that each wheel had rolled at a moment.
class WheelTravel {
 public:
  explicit WheelTravel(const DriveModel& drive) : drive_(drive) {}

  /// Takes a reading once; one that is no number or not newer than the one before is left out.
  void note(const WheelState& wheels) noexcept;
  /// kNever before the first reading.
  [[nodiscard]] Time newest() const noexcept { return readings_[newest_].stamp; }
  /// Interpolates between the readings before and after; nothing where there are none.
  [[nodiscard]] std::optional<Rolled> at(Time stamp) const noexcept;
  /// The same, but up to 0.2 s beyond the newest reading at the speeds between the last two, and later still as that
  /// reading has it; nothing before the first.
  [[nodiscard]] std::optional<Rolled> expected_at(Time stamp) const noexcept;
  /// Mean twist from a moment, at which they had rolled so far, to the newest reading; none where that is no later.
  [[nodiscard]] Twist2 twist_since(Time stamp, const Rolled& rolled) const noexcept;

 private:
  static constexpr std::size_t kMostReadings = 128;
  struct Reading {
    Time stamp = kNever;
    Rolled rolled;
  };

  DriveModel drive_;
  std::array<Reading, kMostReadings> readings_{};
  std::size_t newest_ = 0;
  std::uint32_t seen_ = 0;
};

/// Motion of the robot on the arc that its wheels rolled: its pose at the end in the frame of its start.
[[nodiscard]] Pose2 arc_of(const Rolled& rolled, double track_width_m) noexcept;

/// How far each wheel moved the robot, and how far it went aside, half way through its turn.
struct Moved {
  double left_m = 0.0, right_m = 0.0, aside_m = 0.0;
};
[[nodiscard]] Moved moved_to(const Pose2& end_in_start, double track_width_m) noexcept;

/// Proof that the wheels go as far as they say, over the first way after arming, by the scans of one scanner.
///
/// Counts, gears and radii that are typed wrong show in nothing else. Until the proof a wheel's rim goes at most
/// kFirst_mps, then kSlow_mps: ten times as far is a walk at most before it is told. The newest scan is matched to the
/// one kept when the wheels stood last (ScanPair); each wheel's way by that match is held against its counter's. In
/// open ground, where scans tell nothing, the slow metre is all there is. Thread: the loop's; memory is fixed.
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
