#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/types/fixed_vector.h"
#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"
#include "hal/types/wheels.h"

namespace jaywalk {

/// Tests the wheels' motion against two raw scans, with neither map nor planner (SAFETY 18).
///
/// The hits of a kept scan are moved by what the wheels rolled since, and compared with a newer scan: the distance of
/// each to the surface seen in its direction. The same is done for the motions that wrong wiring or lost grip would
/// make of the same wheel angles (kWrong in the .cc). Where one of those explains 20 % of the points better, those that
/// it explains worse taken off, and leaves less than 0.6 of the error, again and again for kFor, the motion is
/// contradicted. A wheel that moves the robot by half of what it rolls is still slip; by a quarter or less it is a
/// fault.
///
/// Told within 0.5 s at 0.2 m/s or 0.3 rad/s, where the scans can tell: not in open ground, not along a corridor
/// without features, and a mirrored scanner only in turns. Movers that fill 20 % of the view and go
/// along with the robot would deceive it. Thread: the loop's. Memory is fixed (45 kB); a
/// scan costs 0.05 to 0.2 ms on average (recorded runs, desktop).
class SeenMotion {
 public:
  explicit SeenMotion(const RobotModel& model);

  /// Once a tick, with the newest scan and reading. True while the scans contradict the wheels, and for kHolds after.
  [[nodiscard]] bool contradicts(const LaserScan& scan, const WheelState& wheels, Time now) noexcept;

  static constexpr Duration kFor = std::chrono::milliseconds(120);
  static constexpr Duration kHolds = std::chrono::milliseconds(500);

 private:
  static constexpr std::size_t kMostPoints = 120, kMostReadings = 128;
  /// How far each wheel's rim has rolled (m) since start.
  struct Rolled {
    double left_m = 0.0, right_m = 0.0;
  };
  struct Reading {
    Time stamp = kNever;
    Rolled rolled;
  };
  struct Point {
    std::uint32_t beam = 0;
    float range_m = 0.0F;
    Vec2 in_robot;
  };
  struct Errors {
    FixedVector<float, kMostPoints> point_m;  ///< of each kept point; NaN where it could not be compared
    double mean_m = 0.0;
    std::size_t compared = 0;
  };

  void note(const WheelState& wheels) noexcept;
  [[nodiscard]] bool rolled_at(Time stamp, Rolled& rolled) const noexcept;
  [[nodiscard]] bool usable(const LaserScan& scan) noexcept;
  void keep(const LaserScan& scan, const Rolled& rolled) noexcept;
  [[nodiscard]] bool is_kept_again(const LaserScan& scan) const noexcept;
  void look(const LaserScan& scan) noexcept;
  [[nodiscard]] bool is_better_explained(const LaserScan& scan, const Rolled& felt) const noexcept;
  [[nodiscard]] Errors with_slip(const LaserScan& scan, const Rolled& felt, const Errors& none) const noexcept;
  [[nodiscard]] static bool leaves_to_explain(const Errors& errors) noexcept;
  [[nodiscard]] bool differs(const Rolled& a, const Rolled& b) const noexcept;
  [[nodiscard]] static bool explains_better(const Errors& wrong, const Errors& right) noexcept;
  [[nodiscard]] Errors errors(const LaserScan& scan, const Rolled& moved) const noexcept;
  [[nodiscard]] double error_m(const LaserScan& scan, Vec2 in_laser) const noexcept;

  DriveModel drive_;
  Pose2 robot_from_laser_;
  std::array<Reading, kMostReadings> readings_{};
  std::size_t newest_ = 0;
  std::uint32_t wheels_seen_ = 0, scan_seen_ = 0;

  std::array<Vec2, kMaxBeams> direction_{};  ///< of the beams, in the laser's frame
  std::uint32_t beams_ = 0;                  ///< those directions are of
  float first_angle_rad_ = 0.0F, angle_step_rad_ = 0.0F;

  FixedVector<Point, kMostPoints> kept_;
  Time kept_stamp_ = kNever;
  Rolled kept_rolled_;
  Time suspected_ = kNever;     ///< the first scan of those that contradict without a break
  Time contradicted_ = kNever;  ///< when that was last said
};

}  // namespace jaywalk
