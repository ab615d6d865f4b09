#pragma once
// Stop zone: how far the robot can go along a twist, and whether its lasers reach as far as it needs to stop.
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>

#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"
#include "hal/types/time.h"

namespace jaywalk {
/// Poses of the robot along a constant twist, one for every 4 cm that the fastest-moving part of its footprint goes.
class SweptPath {
 public:
  static constexpr double kStep_m = 0.04;  ///< half a 70 mm cylinder and a bit: none slips between two steps
  static constexpr std::size_t kMostSteps = 512;
  static constexpr double kLongest_m = kStep_m * kMostSteps;

  /// `rim_mps`: speed of the fastest-moving part, above 0; `length_m`: how far that goes, kLongest_m at most.
  SweptPath(const Twist2& twist, double rim_mps, double length_m) noexcept
      : steps_(std::min(static_cast<std::size_t>(std::min(length_m, kLongest_m) / kStep_m) + 1, kMostSteps)) {
    const double step_s = kStep_m / rim_mps;
    // Driving a chord and then turning differs from the arc by less than 0.3 mm a step.
    const double ahead_m = twist.v_mps * step_s;
    const Vec2 turn = direction(twist.w_radps * step_s);
    poses_[0] = {{}, {1.0, 0.0}};
    for (std::size_t k = 0; k < steps_; ++k) {
      const Pose& before = poses_[k];
      const Vec2 ahead = before.axis;
      poses_[k + 1] = {before.position + ahead * ahead_m,
                       {ahead.x * turn.x - ahead.y * turn.y, ahead.y * turn.x + ahead.x * turn.y}};
    }
  }

  [[nodiscard]] std::size_t steps() const noexcept { return steps_; }
  /// A place of the robot's frame at the start, as the robot sees it after step k of steps().
  [[nodiscard]] Vec2 seen_from(std::size_t k, Vec2 place) const noexcept {
    const Vec2 d = place - poses_[k].position;
    return {dot(poses_[k].axis, d), cross(poses_[k].axis, d)};
  }
  /// Where a point of the robot's is after step k of steps(), in the robot's frame at the start.
  [[nodiscard]] Vec2 place_of(std::size_t k, Vec2 point) const noexcept {
    const Vec2 axis = poses_[k].axis;
    return poses_[k].position + Vec2{axis.x * point.x - axis.y * point.y, axis.y * point.x + axis.x * point.y};
  }

 private:
  struct Pose {
    Vec2 position;
    Vec2 axis;  ///< unit vector of the heading
  };
  std::size_t steps_;
  std::array<Pose, kMostSteps + 1> poses_;
};

[[nodiscard]] OfOthers<Pose2> other_mounts(const RobotModel& model) noexcept;

/// From the left one in front counter-clockwise, in the robot's frame.
[[nodiscard]] inline std::array<Vec2, 4> corners_of(const Footprint& body) noexcept {
  const double front = body.front_m, rear = -body.rear_m, half = body.half_width_m;
  return {{{front, half}, {rear, half}, {rear, -half}, {front, -half}}};
}

struct StopZoneConfig {
  Footprint footprint;
  Pose2 robot_from_laser;
  double margin_m = StopZoneRules<double>::kMargin_m;
  double brake_mps2 = 1.0;              ///< what the drive was proved to do
  double look_ahead_m = 2.0;            ///< how far the rim goes, at its fastest, until the robot stands
  OfOthers<Pose2> robot_from_others{};  ///< the other lasers' mounts
};

/// How far the robot can go along a constant twist before its footprint, grown by the margin, meets a point of the raw
/// scans; m along the fastest-moving part of the footprint, so that turning in place counts too. Points that the motion
/// takes the robot away from do not count, or it could never leave what it faces.
class StopZone {
 public:
  explicit StopZone(const StopZoneConfig& config);

  /// +infinity when nothing is met within the look-ahead. `unseen`: what stands where the laser does not look, in the
  /// robot's frame. Cost: a few steps of 4 cm for each beam and point within reach.
  [[nodiscard]] double gap_m(const OfEach<LaserScan>& scans, const Twist2& twist,
                             std::span<const Vec2> unseen = {}) const noexcept;
  /// Whether it may creep on beside what is near already (StopZoneRules), over all of the way that it looks along. A
  /// surface is in the mean of the beams that meet 3 cm of it: noise would keep the robot there, or let it come too
  /// near.
  [[nodiscard]] bool may_creep(const OfEach<LaserScan>& scans, const Twist2& twist, std::span<const Vec2> unseen,
                               double reaction_s) const noexcept;
  /// From the axle: nothing farther off counts.
  [[nodiscard]] double reach_m() const noexcept { return rim_radius_m_ + config_.margin_m + config_.look_ahead_m; }
  /// Whether a beam ends within the footprint, on the robot or on a person touching it: all but leaving is forbidden.
  [[nodiscard]] bool is_on_body(const LaserScan& scan, std::size_t beam) const noexcept;
  [[nodiscard]] std::size_t beams_on_body(const LaserScan& scan) const noexcept;
  /// What is kept free round the footprint (m) at this speed of its rim.
  [[nodiscard]] double margin_at(double rim_mps) const noexcept;
  /// Speed of the fastest-moving part of the footprint, m/s.
  [[nodiscard]] double rim_speed_mps(const Twist2& twist) const noexcept {
    return std::fabs(twist.v_mps) + std::fabs(twist.w_radps) * rim_radius_m_;
  }
  /// How far the rim goes from this speed until the robot stands: v t + v^2 / (2 b), t the reaction time.
  [[nodiscard]] double stopping_distance_m(double rim_mps, double reaction_s) const noexcept {
    return rim_mps * reaction_s + rim_mps * rim_mps / (2.0 * config_.brake_mps2);
  }
  /// The fastest rim speed from which the robot still stops within `gap_m`.
  [[nodiscard]] double speed_to_stop_within(double gap_m, double reaction_s) const noexcept;

 private:
  [[nodiscard]] const Pose2& mount_of(const LaserScan& scan) const noexcept {
    return OfEach<Pose2>(config_.robot_from_laser, config_.robot_from_others)[scan.scanner];
  }
  /// How far the rim goes before the footprint meets `point` (in the robot's frame); +infinity beyond `most_m`.
  [[nodiscard]] double way_to(Vec2 point, const SweptPath& path, double margin_m, double most_m) const noexcept;

  StopZoneConfig config_;
  double rim_radius_m_;
};

/// Speed (m/s) of the fastest-moving part of the footprint at the limits of speed and turn rate, both at once.
[[nodiscard]] double fastest_rim_mps(const RobotModel& model) noexcept;

/// How far that part goes, m, from its fastest until the robot stands, with worst_reaction_s().
[[nodiscard]] double longest_stop_m(const RobotModel& model, Duration tick) noexcept;

/// The supervisor's stop zone for a robot: it looks ahead as far as longest_stop_m().
[[nodiscard]] StopZoneConfig stop_zone_for(const RobotModel& model, Duration tick) noexcept;

/// Before the loop (SAFETY 8 and 19): throws StartupError, which begins with `place`, where the robot's longest stop
/// does not fit into a laser's range, or so far out a cylinder of 70 mm fits between two of its beams.
void require_zone_in_reach(const RobotModel& model, Duration tick, const std::string& place);

}  // namespace jaywalk
