#pragma once
// The robot's body, drive and lasers: facts about a machine, shared by controller and simulator.
#include <cstddef>
#include <cstdint>
#include <string>

#include "hal/types/fixed_vector.h"
#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"

namespace jaywalk {

// Directions in which a laser sees its own robot: armrests, wheels, masts.

/// From one direction of the laser's frame counter-clockwise to the other, rad, both belonging to it; less than a turn.
struct BlankedSector {
  double from_rad = 0.0;
  double to_rad = 0.0;

  [[nodiscard]] double width_rad() const noexcept;
  /// How far a direction is from it, rad; 0 inside.
  [[nodiscard]] double off_rad(double direction_rad) const noexcept;
};

using Blanking = FixedVector<BlankedSector, 16>;

/// Ranges of beams that look into a sector become `says_m`; minus infinity (LaserScan): they measured the robot.
void blank(std::span<const BlankedSector> sectors, LaserScan& scan,
           float says_m = -std::numeric_limits<float>::infinity()) noexcept;

/// Rules of the supervisor's stop zone (T: double), which roll-outs (float) foresee.
template <class T>
struct StopZoneRules {
  static constexpr T kMargin_m = T(0.08);       ///< kept free round the footprint at kFull_mps of its rim and above
  static constexpr T kCreepMargin_m = T(0.04);  ///< the same at rest; in between in proportion: it passes a door
                                                ///< closely, but slowly
  static constexpr T kFull_mps = T(0.4);
  /// Greatest speed of the rim, m/s, with `gap_m` free before it.
  [[nodiscard]] static constexpr T permitted_rim(T gap_m) noexcept {
    const T over = gap_m > kCreepMargin_m ? gap_m - kCreepMargin_m : T(0);
    return over / (kMargin_m - kCreepMargin_m) * kFull_mps;
  }
  /// Beside what is nearer than kBeside_m already, the rim may creep: no nearer than that by more than kSwing_m, nor
  /// nearer than kLeast_m.
  static constexpr T kBeside_m = T(0.07), kCreep_mps = T(0.1), kSwing_m = T(0.01), kLeast_m = T(0.02);
};

/// A rectangle about the drive axle's middle, aligned with the robot.
struct Footprint {
  double front_m = 0.0;  ///< from the axle to the foremost point
  double rear_m = 0.0;   ///< from the axle to the rearmost point, positive
  double half_width_m = 0.0;

  /// Largest circle about the axle's middle that fits inside.
  [[nodiscard]] double inscribed_radius_m() const { return std::min({front_m, rear_m, half_width_m}); }
  /// Smallest circle about the axle's middle that holds it.
  [[nodiscard]] double circumscribed_radius_m() const { return norm({std::max(front_m, rear_m), half_width_m}); }
  /// Distance (m) from a point in the robot's frame to the rectangle; 0 inside.
  [[nodiscard]] double distance_to(Vec2 p_in_robot) const {
    const double beyond_x = std::max({p_in_robot.x - front_m, -rear_m - p_in_robot.x, 0.0});
    const double beyond_y = std::max(std::fabs(p_in_robot.y) - half_width_m, 0.0);
    return norm({beyond_x, beyond_y});
  }
};

/// Report period, lateness and response time of a drive: stated by its maker or measured.
struct DriveTimes {
  double report_s = 0.02;    ///< between two reports
  double late_s = 0.0;       ///< a report may come so much later than its turn
  double response_s = 0.05;  ///< from a command until the wheels turn so, ramps apart

  /// Age (s) up to which the newest report is no fault: one may be lost, and the next one late.
  [[nodiscard]] double oldest_report_s() const { return 2.0 * report_s + std::max(late_s, 0.5 * report_s); }
  /// Longest time from a command until a sound drive's newest report shows it obeyed, ramps apart, s.
  [[nodiscard]] double obeyed_within_s() const {
    constexpr double kTickAndBus_s = 0.13;  // two ticks of 20 Hz and a frame that waits for others
    return kTickAndBus_s + response_s + report_s + late_s;
  }
  /// Time (s) by which that is longer than of a drive that reports and obeys as usual, in a loop of period `tick_s`.
  [[nodiscard]] double slower_s(double tick_s) const {
    const DriveTimes usual;
    return std::max(response_s - usual.response_s, 0.0) + std::max(report_s - std::max(usual.report_s, tick_s), 0.0) +
           late_s;
  }
};

struct DriveModel {
  double wheel_radius_m = 0.0;
  double track_width_m = 0.0;          ///< between the wheels' contact points
  double max_wheel_speed_radps = 0.0;  ///< what the motors can do
  DriveTimes times{};
};

struct MotionLimits {
  double max_speed_mps = 0.0;
  double max_turn_radps = 0.0;
  double max_accel_mps2 = 0.0;  ///< comfort: speeding up and slowing down as planned
  double max_turn_accel_radps2 = 0.0;
  double max_jerk_mps3 = 0.0;
  double brake_mps2 = 0.0;  ///< what the drive is proved to be able to do
};

struct LaserModel {
  Pose2 robot_from_laser;
  double fov_rad = 0.0;  ///< from the first beam to the last, centred ahead
  std::uint32_t beams = 0;
  double rate_hz = 0.0;
  double range_min_m = 0.0;
  double range_max_m = 0.0;
  double noise_m = 0.0;   ///< standard deviation of a range
  double drop_out = 0.0;  ///< share of beams that return nothing, in [0, 1]
  Blanking blanked{};     ///< where it sees the robot itself
  bool turns = false;     ///< simulated: its beams are measured one after another; else all at once
};

struct RobotModel {
  std::string name;
  Footprint footprint;
  DriveModel drive;
  MotionLimits limits;
  LaserModel laser;                     ///< the first
  OfOthers<LaserModel> other_lasers{};  ///< each as a scanner of its own: other mount, rate and clock

  [[nodiscard]] OfEach<LaserModel> lasers() const noexcept { return {laser, other_lasers}; }
};

/// "front", "rear", "left" or "right" by where it is mounted, with a number where an earlier one has the name: what
/// messages and topics call a scanner. "" where there is one alone.
[[nodiscard]] std::string scanner_name(const RobotModel& model, std::size_t scanner);

/// Pioneer P3-DX with ODrives in place of its own board, and a 270 degree scanner: 0.511 m x 0.425 m.
[[nodiscard]] RobotModel p3dx();
/// A power wheelchair, 0.65 m x 1.10 m, turning about its drive axle 0.35 m from its rear.
[[nodiscard]] RobotModel wheelchair();

}  // namespace jaywalk
