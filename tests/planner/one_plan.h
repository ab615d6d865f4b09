#pragma once
// A planner of little memory, asked for a plan.
#include <memory>

#include "planner/paper/paper.h"

namespace jaywalk::test {

/// The paper's planner, or the robot's.
inline std::unique_ptr<Planner> planner_of(bool is_paper, std::int32_t max_side_cells = 256) {
  paper::PaperConfig config;
  config.max_side_cells = max_side_cells;
  return is_paper ? paper::make_cpu_paper_planner(config) : make_cpu_planner(config);
}

inline double length_of(const Path& path) {
  double sum = 0.0;
  for (std::size_t k = 1; k < path.size(); ++k) sum += distance(path[k - 1], path[k]);
  return sum;
}

inline PlanRequest request_on(const EvidenceMap& map, Vec2 from, Vec2 to) {
  PlanRequest request;
  request.stamp = time_from_seconds(1.0);
  request.map_from_robot = {from.x, from.y, 0.0};
  request.goal_in_map = to;
  request.speed_mps = 0.6;
  request.still = &map;
  return request;
}

inline const Plan& plan_of(Planner& planner, const PlanRequest& request) {
  planner.submit(request);
  return planner.collect();
}

inline Track walker(Vec2 at, Vec2 velocity) {
  Track track;
  track.id = 7;
  track.position_in_map = at;
  track.velocity_in_map = velocity;
  track.covariance = {0.001, 0.0, 0.002};
  track.radius_m = 0.27;
  return track;
}

}  // namespace jaywalk::test
