#pragma once
// A room with furniture and people for random trials, and what a laser sees of it by the simulator's rays.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "hal/maps/wall_map.h"
#include "tests/safety/scans.h"

namespace jaywalk::trials {

using Engine = std::mt19937_64;

inline double uniform(Engine& engine, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(engine);
}

using Wall = sim::WallSegment;
/// A pedestrian, round, who walks straight and turns where the room ends.
struct Walker {
  Vec2 centre, velocity;
  double radius_m = 0.2;
};

/// Distance that a ray runs; infinity where it meets nothing.
[[nodiscard]] inline double range(std::span<const Wall> walls, std::span<const Walker> walkers, Vec2 from, Vec2 way) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Wall& wall : walls) nearest = std::min(nearest, sim::hit_range(from, way, wall));
  for (const Walker& walker : walkers)
    nearest = std::min(nearest, sim::hit_range(from, way, sim::Disc{walker.centre, walker.radius_m}));
  return nearest;
}

/// Turned against the axes, 5 to 11 m by 4 to 8 m, with 3 to 9 pieces of furniture.
class Room {
 public:
  Room(Engine& engine, int people) : half_{uniform(engine, 2.5, 5.5), uniform(engine, 2.0, 4.0)} {
    turn_ = uniform(engine, -kPi, kPi);
    add_box({0.0, 0.0}, half_, 0.0);
    const int pieces = static_cast<int>(uniform(engine, 3.0, 10.0));
    for (int k = 0; k < pieces; ++k) {
      const Vec2 place{uniform(engine, -half_.x, half_.x), uniform(engine, -half_.y, half_.y)};
      if (norm(place) < 1.7) continue;  // the robot starts there
      add_box(place, {uniform(engine, 0.1, 0.6), uniform(engine, 0.1, 0.4)}, uniform(engine, -kPi, kPi));
    }
    for (int k = 0; k < people; ++k) {
      const double way = uniform(engine, -kPi, kPi), speed = uniform(engine, 0.0, 1.3);
      const Vec2 place = direction(uniform(engine, -kPi, kPi)) * 1.6;
      walkers_.push_back({place, direction(way) * speed, uniform(engine, 0.15, 0.3)});
    }
  }

  /// People turn round before they walk into the robot.
  void move(double step_s, Vec2 robot) {
    for (Walker& walker : walkers_) {
      const Vec2 to_robot = robot - walker.centre;
      const bool approaches = dot(to_robot, walker.velocity) > 0.0;
      if (approaches && norm(to_robot) < 0.7 + walker.radius_m) walker.velocity = walker.velocity * -1.0;
      walker.centre = walker.centre + walker.velocity * step_s;
      const Vec2 in_room = turned(walker.centre, -turn_);
      Vec2 way = turned(walker.velocity, -turn_);
      if (in_room.x * way.x > 0.0 && std::fabs(in_room.x) > half_.x - 0.4) way.x = -way.x;
      if (in_room.y * way.y > 0.0 && std::fabs(in_room.y) > half_.y - 0.4) way.y = -way.y;
      walker.velocity = turned(way, turn_);
    }
  }
  [[nodiscard]] double range(Vec2 from, Vec2 way) const { return trials::range(walls_, walkers_, from, way); }

 private:
  static Vec2 turned(Vec2 v, double by) { return Transform2({0.0, 0.0, by}).rotate(v); }
  void add_box(Vec2 centre, Vec2 half, double heading) {
    const Vec2 corner[4] = {{half.x, half.y}, {-half.x, half.y}, {-half.x, -half.y}, {half.x, -half.y}};
    for (int k = 0; k < 4; ++k)
      walls_.push_back({turned(centre + turned(corner[k], heading), turn_),
                        turned(centre + turned(corner[(k + 1) % 4], heading), turn_)});
  }

  Vec2 half_;
  double turn_ = 0.0;
  std::vector<Wall> walls_;
  std::vector<Walker> walkers_;
};

/// A scan's ranges from a pose of the laser, without noise.
inline void sweep(const Room& room, const Pose2& map_from_laser, const LaserModel& laser, LaserScan& scan) {
  tests::lay_beams(scan, laser);
  for (std::size_t k = 0; k < scan.beam_count; ++k) {
    const Vec2 way = direction(map_from_laser.heading + scan.angle_rad(k));
    scan.range_m[k] = static_cast<float>(room.range(map_from_laser.position(), way));
  }
}

}  // namespace jaywalk::trials
