#include "planner/tracking/target.h"

namespace jaywalk {
namespace {

constexpr double kFirstSpeedStd = 1.0;  // m/s an axis: people walk at 1.3 m/s

/// Whether `a` is to go rather than `b` where there is no room for both.
bool matters_less(const Target& a, const Target& b, Vec2 robot) {
  if (a.appearance.on_wall != b.appearance.on_wall) return a.appearance.on_wall;
  return distance(a.estimate.track.position_in_map, robot) > distance(b.estimate.track.position_in_map, robot);
}

}  // namespace

Target born_at(Vec2 position, double std_m, double radius, Time now, std::uint32_t id) noexcept {
  Target target;
  Track& track = target.estimate.track;
  track.id = id;
  track.stamp = now;
  track.position_in_map = position;
  track.covariance = {.pp = std_m * std_m, .pv = 0.0, .vv = kFirstSpeedStd * kFirstSpeedStd};
  track.radius_m = radius;
  track.hits = 1;
  track.last_seen = now;
  target.estimate.as_seen = track;
  target.estimate.filter = ImmFilter(track);
  target.onset.anchor_in_map = position;
  target.onset.positions.add(now, {position});
  target.onset.anchored = now;
  target.existence.born = now;
  return target;
}

void anchor_here(OnsetHistory& onset, Vec2 position, const Appearance& seen, const Pose2& map_from_laser,
                 Time now) noexcept {
  onset.anchor_in_map = position;
  onset.anchor_outline = seen.outline_in_map;
  onset.anchor_low_seen = seen.low_seen();
  onset.anchor_high_seen = seen.high_seen();
  onset.anchor_in_laser = inverse(map_from_laser) * position;
  onset.anchored = now;
}

void move_all(Estimate& estimate, OnsetHistory& onset, Vec2 by_m) noexcept {
  estimate.track.position_in_map = estimate.track.position_in_map + by_m;
  estimate.filter.move(by_m);
  onset.anchor_in_map = onset.anchor_in_map + by_m;
  onset.positions.move(by_m);
}

void admit(Targets& targets, const Target& newcomer, Vec2 robot) noexcept {
  if (targets.full()) {
    std::size_t least = 0;
    for (std::size_t k = 1; k < targets.size(); ++k) {
      if (matters_less(targets[k], targets[least], robot)) least = k;
    }
    if (!matters_less(targets[least], newcomer, robot)) return;
    targets.swap_remove(least);
  }
  (void)targets.push_back(newcomer);  // there is room now
}

}  // namespace jaywalk
