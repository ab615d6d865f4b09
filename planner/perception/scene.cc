#include "planner/perception/scene.h"

#include "planner/perception/touching_bodies.h"

namespace jaywalk {

void Scene::look(const LaserScan& scan, const Pose2& map_from_robot, const Twist2& twist, const EvidenceMap& still,
                 const Bodies& bodies) noexcept {
  self_mask_.learn(scan, map_from_robot.heading);
  projection_.project(scan, robot_from_laser_, twist, points);
  drop_own_points();
  const Sweep sweep = sweep_of(scan);
  begin_at_a_jump(sweep, points);
  map_from_laser = map_from_robot * robot_from_laser_;
  const Transform2 to_map(map_from_robot);
  for (std::size_t k = 0; k < points.size(); ++k) {
    in_map.position[k] = to_map * points[k].in_robot;
    in_map.ground[k] = ground_at(still, in_map.position[k], points[k].range_m);
  }
  cut_at_jumps(points, sweep, segments_);
  cut_between(bodies, in_map, segments_);
  find_clusters(points, in_map, segments_, sweep, map_from_laser.position(), clusters);
}

void Scene::drop_own_points() noexcept {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!self_mask_.on_robot(points[k].beam)) points[kept++] = points[k];
  }
  points.truncate(kept);
}

}  // namespace jaywalk
