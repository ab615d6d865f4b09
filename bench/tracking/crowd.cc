#include "bench/tracking/crowd.h"

#include <cmath>

#include "planner/tracking/track.h"

namespace jaywalk::bench {
namespace {
constexpr double kRate = 15.0;                       // scans a second
constexpr double kCircle = 0.3, kTurn = 0.5;         // m, rad/s: the robot's circle, at 0.15 m/s
constexpr double kSpeed = 0.7, kWalk = 1.5;          // m/s, m: to and fro
constexpr double kNearest = 4.5, kSecondRing = 6.5;  // m from the hall's middle: every other walker farther off
constexpr double kWalker = 0.2, kPillar = 0.15;      // m, radii
constexpr std::uint32_t kBeams = 1081, kPillars = 24;

RobotModel all_round() {
  RobotModel model = p3dx();
  model.laser.fov_rad = 2.0 * kPi * (kBeams - 1) / kBeams;
  model.laser.beams = kBeams;
  model.laser.rate_hz = kRate;
  model.laser.range_max_m = 25.0;
  model.laser.noise_m = 0.01;
  return model;
}

sim::WallMap hall() {
  constexpr Vec2 kCorners[] = {{-12.0, -10.0}, {12.0, -10.0}, {12.0, 10.0}, {-12.0, 10.0}};
  sim::WallMap map;
  for (int k = 0; k < 4; ++k) map.segments.push_back({kCorners[k], kCorners[(k + 1) % 4]});
  for (std::uint32_t k = 0; k < kPillars; ++k)
    map.discs.push_back({direction(2.0 * kPi * k / kPillars) * 9.0, kPillar});
  return map;
}

/// How far walker `k` has come along its ray by `t_s`: a triangle between 0 and kWalk.
double walked_m(std::size_t k, double t_s) {
  const double way = std::fmod(kSpeed * t_s + 0.37 * static_cast<double>(k), 2.0 * kWalk);
  return way < kWalk ? way : 2.0 * kWalk - way;
}

}  // namespace

Crowd::Crowd() : model_(all_round()), walls_(hall()), laser_(model_.laser, 1), walkers_(kMaxTracks) {}

Pose2 Crowd::start() const { return {kCircle, 0.0, 0.5 * kPi}; }

CrowdWatcher::CrowdWatcher(const Crowd& crowd)
    : localizer({.map_from_robot_at_start = crowd.start(),
                 .drive = crowd.model().drive,
                 .robot_from_laser = crowd.model().laser.robot_from_laser}),
      tracker({.robot_from_laser = crowd.model().laser.robot_from_laser, .map_centre = {}}) {}

void Crowd::at(std::uint32_t k, LaserScan& scan, WheelState& wheels) {
  const double t_s = k / kRate, turned = kTurn * t_s;
  for (std::size_t w = 0; w < walkers_.size(); ++w) {
    const double from = w % 2 == 0 ? kNearest : kSecondRing;
    const double bearing = 2.0 * kPi * static_cast<double>(w) / static_cast<double>(walkers_.size());
    walkers_[w] = {direction(bearing) * (from + walked_m(w, t_s)), kWalker};
  }
  const Vec2 place = direction(wrap_angle(turned)) * kCircle;
  laser_.sweep(walls_, walkers_, {place.x, place.y, wrap_angle(turned + 0.5 * kPi)}, time_from_seconds(t_s), scan);
  scan.sequence = k + 1;
  const double half = 0.5 * model_.drive.track_width_m, radius = model_.drive.wheel_radius_m;
  wheels = {.stamp = scan.stamp,
            .sequence = k + 1,
            .left_rad = (kCircle - half) * turned / radius,
            .right_rad = (kCircle + half) * turned / radius};
}

}  // namespace jaywalk::bench
