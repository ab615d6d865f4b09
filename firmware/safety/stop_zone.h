#pragma once
#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"

namespace jaywalk {

struct StopZoneConfig {
  Footprint footprint;
  Pose2 robot_from_laser;
  double margin_m = 0.08;        ///< kept free round the footprint at kFullMargin_mps of its rim and above
  double creep_margin_m = 0.04;  ///< the same at rest; in between in proportion: it passes a door closely, but slowly
  double brake_mps2 = 1.0;       ///< what the drive was proved to do
  double reaction_s = 0.0;       ///< oldest scan accepted + control + drive
  double look_ahead_m = 2.0;     ///< nothing further away can matter at the speeds allowed
};

/// How far the robot can go along a constant twist before its footprint, grown by the margin, meets a point of the raw
/// scan. "Far" is measured along the fastest-moving part of the footprint (m), so that turning in place counts too.
///
/// Points that the motion takes the robot away from do not count, or it could never leave what it faces.
class StopZone {
 public:
  explicit StopZone(const StopZoneConfig& config);

  /// +infinity when nothing is met within the look-ahead. Cost: steps of 4 cm times beams within reach.
  [[nodiscard]] double gap_m(const LaserScan& scan, const Twist2& twist) const noexcept;
  /// Whether a beam ends within the footprint: on a part of the robot itself, or on somebody who touches it. Such a
  /// point forbids every motion that does not leave it.
  [[nodiscard]] bool is_on_body(const LaserScan& scan, std::size_t beam) const noexcept;
  /// How many do.
  [[nodiscard]] std::size_t beams_on_body(const LaserScan& scan) const noexcept;
  /// What is kept free round the footprint (m) at this speed of its rim.
  [[nodiscard]] double margin_at(double rim_mps) const noexcept;
  /// Speed of the fastest-moving part of the footprint, m/s.
  [[nodiscard]] double rim_speed_mps(const Twist2& twist) const noexcept;
  /// The fastest rim speed from which the robot still stops within `gap_m`: v t + v^2 / (2 b) = gap. t is the
  /// reaction time and what a scan's first beam is older than its last.
  [[nodiscard]] double speed_to_stop_within(double gap_m, Duration sweep = Duration{0}) const noexcept;

  static constexpr double kFullMargin_mps = 0.4;

 private:
  /// What the robot does while its rim goes one step.
  struct Step {
    double ahead_m = 0.0;
    Vec2 turn_back;  ///< unit vector at minus the turned angle
  };
  /// How far the rim goes before the footprint meets `point` (in the robot's frame); +infinity beyond `most_m`.
  [[nodiscard]] double way_to(Vec2 point, const Step& step, double margin_m, double most_m) const noexcept;

  StopZoneConfig config_;
  double rim_radius_m_;
};

}  // namespace jaywalk
