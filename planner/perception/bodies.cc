#include "planner/perception/bodies.h"

namespace jaywalk {
namespace {

constexpr double kFirstSpeedStd = 1.0;  // m/s an axis: people walk at 1.3 m/s

std::size_t farthest(const Bodies& bodies, Vec2 robot) {
  std::size_t worst = 0;
  for (std::size_t k = 1; k < bodies.size(); ++k) {
    const Vec2 p = bodies[k].track.position_in_map;
    if (distance(p, robot) > distance(bodies[worst].track.position_in_map, robot)) worst = k;
  }
  return worst;
}

}  // namespace

Body born_at(Vec2 position, double std_m, double radius, Time now, std::uint32_t id) noexcept {
  Body body;
  body.track.id = id;
  body.track.stamp = now;
  body.track.position_in_map = position;
  body.track.covariance = {.pp = std_m * std_m, .pv = 0.0, .vv = kFirstSpeedStd * kFirstSpeedStd};
  body.track.radius_m = radius;
  body.track.hits = 1;
  body.track.last_seen = now;
  body.as_seen = body.track;
  body.models = MotionModels(body.track);
  body.anchor_in_map = position;
  body.path.add(now, position);
  body.born = now;
  body.still_since = now;
  return body;
}

void anchor_here(Body& body, const Pose2& map_from_laser, Time now) noexcept {
  body.anchor_in_map = body.track.position_in_map;
  body.anchor_outline = body.outline_in_map;
  body.anchor_in_laser = inverse(map_from_laser) * body.track.position_in_map;
  body.still_since = now;
}

void forget_walk(Body& body, const Pose2& map_from_laser, Time now) noexcept {
  body.path.clear();
  body.walked = 0;
  anchor_here(body, map_from_laser, now);
}

void admit(Bodies& bodies, const Body& newcomer, Vec2 robot) noexcept {
  if (bodies.full()) {
    const std::size_t k = farthest(bodies, robot);
    const Vec2 p = bodies[k].track.position_in_map;
    if (distance(newcomer.track.position_in_map, robot) >= distance(p, robot)) return;
    bodies.swap_remove(k);
  }
  (void)bodies.push_back(newcomer);  // there is room now
}

}  // namespace jaywalk
