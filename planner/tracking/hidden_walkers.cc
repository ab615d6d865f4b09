#include "planner/tracking/hidden_walkers.h"

#include <algorithm>

namespace jaywalk {
namespace {

constexpr double kSpeedStd = 0.1;  // m/s an axis, of one that comes out where it should; by trial, seeds 1 to 6

}  // namespace

Vec2 HiddenWalkers::Walker::place_at(Time now) const {
  return as_seen.position_in_map + as_seen.velocity_in_map * to_seconds(now - as_seen.last_seen);
}

void HiddenWalkers::remember(const Body& body) noexcept {
  if (to_seconds(body.as_seen.last_seen - body.born) < kTentativeS) return;
  if (walkers_.full()) {
    const auto earlier = [](const Walker& a, const Walker& b) { return a.as_seen.last_seen < b.as_seen.last_seen; };
    const Walker* first = std::min_element(walkers_.begin(), walkers_.end(), earlier);
    walkers_.swap_remove(static_cast<std::size_t>(first - walkers_.begin()));
  }
  (void)walkers_.push_back({body.as_seen, body.arc_m, body.born});  // there is room now
}

void HiddenWalkers::wait(const LineOfSight& sight, Time now, double step_s) noexcept {
  for (std::size_t k = walkers_.size(); k-- > 0;) {
    Walker& walker = walkers_[k];
    if (sight.at(walker.place_at(now), kEmptyWithinM) == Sight::kThrough) walker.looked_through_s += step_s;
    const double away_s = to_seconds(now - walker.as_seen.last_seen);
    if (away_s < 0.0 || away_s > kRememberedS || walker.looked_through_s > kLookedThroughForS) walkers_.swap_remove(k);
  }
}

bool HiddenWalkers::lost_near(Vec2 place, double within_m) const noexcept {
  return std::any_of(walkers_.begin(), walkers_.end(),
                     [&](const Walker& w) { return distance(w.as_seen.position_in_map, place) < within_m; });
}

bool HiddenWalkers::return_as(Body& newcomer, Time now) noexcept {
  std::size_t who = walkers_.size();
  double nearest = kStrideM;  // simulated seeds 1 to 4: 0.5 m loses four names, 0.75 m makes others of some
  for (std::size_t k = 0; k < walkers_.size(); ++k) {
    const double off = distance(walkers_[k].place_at(now), newcomer.track.position_in_map);
    if (off < nearest) nearest = off, who = k;
  }
  if (who == walkers_.size()) return false;
  const Walker walker = walkers_[who];
  walkers_.swap_remove(who);
  Track& track = newcomer.track;
  track.id = walker.as_seen.id;
  track.velocity_in_map = walker.as_seen.velocity_in_map;
  track.covariance.vv = kSpeedStd * kSpeedStd;
  track.radius_m = walker.as_seen.radius_m;
  track.hits += walker.as_seen.hits;
  track.moving = true;
  track.position_in_map = track.position_in_map - track.velocity_in_map * newcomer.late_by(newcomer.late_s);
  newcomer.as_seen = track;
  newcomer.models = MotionModels(track);
  newcomer.arc_m = walker.arc_m;
  newcomer.born = walker.born;
  return true;
}

}  // namespace jaywalk
