#pragma once
// A robot on a plane with some obstacles, driven by the supervisor alone: the simulator's rays, none of the
// controller's formulas.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "firmware/safety/supervisor.h"
#include "hal/maps/wall_map.h"
#include "tests/safety/scans.h"

namespace jaywalk {

/// The same robot with another greatest speed.
inline RobotModel at(RobotModel model, double max_speed_mps) {
  model.limits.max_speed_mps = max_speed_mps;
  return model;
}

/// What stands in the way: a post, or a rectangle that is turned.
struct Obstacle {
  Vec2 centre{};
  double radius_m = 0.0;  ///< of a post; 0: a rectangle
  Vec2 half{};            ///< half of the rectangle's sides
  double heading = 0.0;

  [[nodiscard]] Transform2 map_from_it() const { return Transform2({centre.x, centre.y, heading}); }
  /// How far a ray runs until it meets the obstacle; infinity where it does not.
  [[nodiscard]] double ray(Vec2 from, Vec2 along) const {
    if (radius_m > 0.0) return sim::hit_range(from, along, sim::Disc{centre, radius_m});
    const Transform2 place = map_from_it();
    const Vec2 corners[] = {place * half, place * Vec2{-half.x, half.y}, place * (half * -1.0),
                            place * Vec2{half.x, -half.y}};
    double nearest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 4; ++k)
      nearest = std::min(nearest, sim::hit_range(from, along, sim::WallSegment{corners[k], corners[(k + 1) % 4]}));
    return nearest;
  }
  /// Points all along its rim, 5 mm apart or less.
  [[nodiscard]] std::vector<Vec2> rim() const {
    std::vector<Vec2> points;
    const Transform2 place = map_from_it();
    for (int k = 0; k < 800; ++k) {
      Vec2 p = direction(2.0 * kPi * k / 800) * radius_m;
      if (radius_m == 0.0) {
        const double along = k % 200 / 100.0 - 1.0;
        p = k < 400 ? Vec2{half.x * along, k < 200 ? half.y : -half.y}
                    : Vec2{k < 600 ? half.x : -half.x, half.y * along};
      }
      points.push_back(place * p);
    }
    return points;
  }
};

/// The supervisor's inputs at 50 Hz: scans at the laser's rate, wheels that follow with a lag of 50 ms and at most one
/// and a half times the braking that was proved.
class DrivenRobot {
 public:
  DrivenRobot(const RobotModel& model, std::vector<Obstacle> obstacles, const SupervisorConfig& config)
      : model_(model), obstacles_(std::move(obstacles)), supervisor_(config), tick_s_(to_seconds(config.tick)) {
    input_.has_goal = true;
    tests::lay_beams(scan_, model.laser);
  }
  DrivenRobot(const RobotModel& model, std::vector<Obstacle> obstacles)
      : DrivenRobot(model, std::move(obstacles), SupervisorConfig{.model = model}) {}

  /// What is done to each scan before anything looks at it.
  std::function<void(LaserScan&)> spoil = [](LaserScan&) {};
  /// Whether the loop's map has the obstacles.
  bool knows_obstacles = false;
  double least_m = 10.0;  ///< clearance of a drive()

  Verdict tick(const Twist2& wanted) {
    now_ += duration_from_seconds(tick_s_);
    if (scan_.sequence == 0 || to_seconds(now_ - scan_.stamp) > 1.0 / model_.laser.rate_hz - 1e-6) sweep();
    wheels_.stamp = now_;
    ++wheels_.sequence;
    const Verdict verdict = supervisor_.judge(wanted, {.scans = scan_,
                                                       .wheels = wheels_,
                                                       .input = input_,
                                                       .plan_stamp = now_,
                                                       .now = now_,
                                                       .known_walls = known_walls()});
    for (int k = 0; k < 10; ++k) move(verdict.permitted, 0.1 * tick_s_);
    permitted_mps_ = verdict.permitted.v_mps;
    return verdict;
  }
  /// Straight on, each wish `step_mps` above what was permitted before: a follower's ramp.
  Verdict drive(int ticks, double speed_mps, double step_mps = 0.02) {
    Verdict verdict;
    for (int k = 0; k < ticks; ++k) {
      verdict = tick({std::min(speed_mps, permitted_mps_ + step_mps), 0.0});
      least_m = std::min(least_m, clearance_m());
    }
    return verdict;
  }
  [[nodiscard]] const LaserScan& scan() const { return scan_; }
  [[nodiscard]] const Pose2& pose() const { return pose_; }
  [[nodiscard]] double speed_mps() const { return twist_.v_mps; }
  /// Least distance between the footprint and an obstacle; 0 in contact.
  [[nodiscard]] double clearance_m() const {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec2 p : rims()) least = std::min(least, model_.footprint.distance_to(p));
    return least;
  }

 private:
  std::span<const Vec2> known_walls() {
    known_.clear();
    if (!knows_obstacles) return {};
    for (const Vec2 p : rims())
      if (norm(p) < 1.5) known_.push_back(p);
    return known_;
  }
  /// Points on the rims of all obstacles, in the robot's frame.
  [[nodiscard]] std::vector<Vec2> rims() const {
    std::vector<Vec2> points;
    const Transform2 robot_from_map(inverse(pose_));
    for (const Obstacle& obstacle : obstacles_)
      for (const Vec2 p : obstacle.rim()) points.push_back(robot_from_map * p);
    return points;
  }
  void sweep() {
    scan_.stamp = now_;
    ++scan_.sequence;
    const Pose2 laser = pose_ * model_.laser.robot_from_laser;
    for (std::size_t k = 0; k < scan_.beam_count; ++k) {
      double range = std::numeric_limits<double>::infinity();
      for (const Obstacle& obstacle : obstacles_)
        range = std::min(range, obstacle.ray(laser.position(), direction(laser.heading + scan_.angle_rad(k))));
      scan_.range_m[k] = static_cast<float>(range);
    }
    spoil(scan_);
  }
  void move(const Twist2& wanted, double step_s) {
    const double most = 1.5 * model_.limits.brake_mps2 * step_s;
    twist_.v_mps += std::clamp((wanted.v_mps - twist_.v_mps) * step_s / 0.05, -most, most);
    const double most_turn = most / model_.footprint.circumscribed_radius_m();
    twist_.w_radps += std::clamp((wanted.w_radps - twist_.w_radps) * step_s / 0.05, -most_turn, most_turn);
    const Vec2 way = direction(pose_.heading + 0.5 * twist_.w_radps * step_s) * (twist_.v_mps * step_s);
    pose_ = {pose_.x + way.x, pose_.y + way.y, pose_.heading + twist_.w_radps * step_s};
  }

  RobotModel model_;
  std::vector<Obstacle> obstacles_;
  std::vector<Vec2> known_;  ///< in the robot's frame
  Supervisor supervisor_;
  double tick_s_, permitted_mps_ = 0.0;
  Time now_ = time_from_seconds(1.0);
  LaserScan scan_;
  WheelState wheels_;
  OperatorInput input_;
  Pose2 pose_;
  Twist2 twist_;
};

}  // namespace jaywalk
