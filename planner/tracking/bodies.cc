#include "planner/tracking/bodies.h"

namespace jaywalk {
namespace {

constexpr double kFirstSpeedStd = 1.0;  // m/s an axis: people walk at 1.3 m/s

/// Whether `a` is to go rather than `b` where there is no room for both.
bool matters_less(const Body& a, const Body& b, Vec2 robot) {
  if (a.on_wall != b.on_wall) return a.on_wall;
  return distance(a.track.position_in_map, robot) > distance(b.track.position_in_map, robot);
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
  body.path.add(now, {position});
  body.born = now;
  body.still_since = now;
  return body;
}

void anchor_here(Body& body, const Pose2& map_from_laser, Time now) noexcept {
  body.anchor_in_map = body.track.position_in_map;
  body.anchor_outline = body.outline_in_map;
  body.anchor_low_seen = body.low_seen();
  body.anchor_high_seen = body.high_seen();
  body.anchor_in_laser = inverse(map_from_laser) * body.track.position_in_map;
  body.still_since = now;
}

void move_all(Body& body, Vec2 by_m) noexcept {
  body.track.position_in_map = body.track.position_in_map + by_m;
  body.anchor_in_map = body.anchor_in_map + by_m;
  body.models.move(by_m);
  body.path.move(by_m);
}

void forget_walk(Body& body, const Pose2& map_from_laser, Time now) noexcept {
  body.path.clear();
  body.walked = 0;
  anchor_here(body, map_from_laser, now);
}

void admit(Bodies& bodies, const Body& newcomer, Vec2 robot) noexcept {
  if (bodies.full()) {
    std::size_t least = 0;
    for (std::size_t k = 1; k < bodies.size(); ++k) {
      if (matters_less(bodies[k], bodies[least], robot)) least = k;
    }
    if (!matters_less(bodies[least], newcomer, robot)) return;
    bodies.swap_remove(least);
  }
  (void)bodies.push_back(newcomer);  // there is room now
}

}  // namespace jaywalk
