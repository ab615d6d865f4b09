#include "hal/sim/laser_sim.h"

#include <algorithm>
#include <limits>

namespace jaywalk::sim {

LaserSim::LaserSim(const LaserModel& model, std::uint64_t seed, std::uint64_t index)
    : model_(model),
      in_laser_(model.beams),
      in_map_(model.beams),
      range_(model.beams),
      noise_(seed, Purpose::kRange, index),
      loss_(seed, Purpose::kDropOut, index) {
  const double step = model.fov_rad / (model.beams - 1);
  for (std::size_t k = 0; k < in_laser_.size(); ++k)
    in_laser_[k] = direction(-0.5 * model.fov_rad + static_cast<double>(k) * step);
}

void LaserSim::see_walls(const Walls& walls, const Pose2& map_from_laser) noexcept {
  const Transform2 to_map(map_from_laser);
  for (std::size_t k = 0; k < in_map_.size(); ++k) {
    in_map_[k] = to_map.rotate(in_laser_[k]);
    range_[k] = walls.cast(map_from_laser.position(), in_map_[k], model_.range_max_m);
  }
}

void LaserSim::see(const Disc& mover, Vec2 laser_in_map) noexcept {
  const double nearest = distance(laser_in_map, mover.centre) - mover.radius_m;
  if (nearest > model_.range_max_m) return;
  for (std::size_t k = 0; k < in_map_.size(); ++k)
    range_[k] = std::min(range_[k], hit_range(laser_in_map, in_map_[k], mover));
}

float LaserSim::measured(double range) noexcept {
  const bool lost = loss_.uniform() < model_.drop_out;
  const double noisy = range + model_.noise_m * noise_.normal();
  if (lost || noisy < model_.range_min_m) return 0.0F;
  return noisy <= model_.range_max_m ? static_cast<float>(noisy) : std::numeric_limits<float>::infinity();
}

void LaserSim::sweep(const Walls& walls, std::span<const Disc> movers, const Pose2& map_from_robot, Time now,
                     LaserScan& scan) noexcept {
  const Pose2 map_from_laser = map_from_robot * model_.robot_from_laser;
  see_walls(walls, map_from_laser);
  for (const Disc& mover : movers) see(mover, map_from_laser.position());
  write(now, Duration{0}, scan);
}

Duration LaserSim::turn_takes() const noexcept {
  return duration_from_seconds(model_.fov_rad / (2.0 * kPi) / model_.rate_hz);
}

bool LaserSim::turn(const Walls& walls, std::span<const Disc> movers, const Pose2& map_from_robot, Time now,
                    LaserScan& scan) noexcept {
  if (measured_ == range_.size()) return false;
  const Pose2 map_from_laser = map_from_robot * model_.robot_from_laser;
  const Transform2 to_map(map_from_laser);
  const double gone = std::min(1.0, to_seconds(now - began_) / to_seconds(turn_takes()));
  const auto due = static_cast<std::size_t>(gone * static_cast<double>(range_.size() - 1)) + 1;
  for (; measured_ < due; ++measured_) {
    const Vec2 beam = to_map.rotate(in_laser_[measured_]);
    double& range = range_[measured_];
    range = walls.cast(map_from_laser.position(), beam, model_.range_max_m);
    for (const Disc& mover : movers) range = std::min(range, hit_range(map_from_laser.position(), beam, mover));
  }
  const bool complete = measured_ == range_.size();
  if (complete) write(began_, turn_takes(), scan);
  return complete;
}

void LaserSim::write(Time stamp, Duration sweep, LaserScan& scan) noexcept {
  scan.stamp = stamp;
  scan.beam_count = model_.beams;
  scan.first_angle_rad = static_cast<float>(-0.5 * model_.fov_rad);
  scan.angle_step_rad = static_cast<float>(model_.fov_rad / (model_.beams - 1));
  scan.range_min_m = static_cast<float>(model_.range_min_m);
  scan.range_max_m = static_cast<float>(model_.range_max_m);
  scan.sweep = sweep;
  scan.period = duration_from_seconds(1.0 / model_.rate_hz);
  for (std::size_t k = 0; k < range_.size(); ++k) scan.range_m[k] = measured(range_[k]);
}

}  // namespace jaywalk::sim
