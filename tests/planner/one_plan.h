#pragma once
// A planner of little memory, asked for a plan.
#include "planner/paper/paper.h"

namespace jaywalk::test {

inline paper::PaperConfig small_memory() {
  paper::PaperConfig config;
  config.max_side_cells = 256;
  return config;
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
