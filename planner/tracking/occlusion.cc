#include "planner/tracking/occlusion.h"

#include <algorithm>

#include "planner/tracking/tuning.h"

namespace jaywalk {
namespace {

constexpr double kUnseenForS = 2.0;  // an occluded target stays a track for so long, or for as long as it was seen
constexpr double kSpeedStd = 0.1;    // m/s an axis, of one that comes out where it should; by trial, seeds 1 to 6

}  // namespace

bool is_gone(const Track& track, const Existence& existence, Time now) noexcept {
  const double unseen_s = to_seconds(now - track.last_seen);
  if (existence.given) return unseen_s > kForeseenS;
  if (existence.looked_through_s > kLookedThroughForS) return true;
  if (!existence.confirmed(track)) return unseen_s > kTentativeS;
  const double known_s = to_seconds(track.last_seen - existence.born);
  const double longest_s = track.moving ? kForeseenS : kUnseenForS;
  return unseen_s > std::clamp(known_s, kTentativeS, longest_s);
}

Vec2 OccludedTracks::Occluded::place_at(Time now) const {
  return as_seen.position_in_map + as_seen.velocity_in_map * to_seconds(now - as_seen.last_seen);
}

void OccludedTracks::remember(const Target& target) noexcept {
  const Track& as_seen = target.estimate.as_seen;
  if (to_seconds(as_seen.last_seen - target.existence.born) < kTentativeS) return;
  if (tracks_.full()) {
    const auto earlier = [](const Occluded& a, const Occluded& b) { return a.as_seen.last_seen < b.as_seen.last_seen; };
    const Occluded* first = std::min_element(tracks_.begin(), tracks_.end(), earlier);
    tracks_.swap_remove(static_cast<std::size_t>(first - tracks_.begin()));
  }
  (void)tracks_.push_back({as_seen, target.appearance.arc_m, target.existence.born});  // there is room now
}

void OccludedTracks::update(const LineOfSight& sight, Time now, double step_s) noexcept {
  for (std::size_t k = tracks_.size(); k-- > 0;) {
    Occluded& track = tracks_[k];
    if (sight.at(track.place_at(now), kEmptyWithinM) == Sight::kThrough) track.looked_through_s += step_s;
    const double away_s = to_seconds(now - track.as_seen.last_seen);
    if (away_s < 0.0 || away_s > kRememberedS || track.looked_through_s > kLookedThroughForS) tracks_.swap_remove(k);
  }
}

bool OccludedTracks::reidentify(Target& newcomer, Time now) noexcept {
  std::size_t best = tracks_.size();
  double nearest = kStrideM;  // simulated seeds 1 to 4: 0.5 m loses four identities, 0.75 m makes others of some
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    const double off = distance(tracks_[k].place_at(now), newcomer.estimate.track.position_in_map);
    if (off < nearest) nearest = off, best = k;
  }
  if (best == tracks_.size()) return false;
  const Occluded old = tracks_[best];
  tracks_.swap_remove(best);
  Track& track = newcomer.estimate.track;
  track.id = old.as_seen.id;
  track.velocity_in_map = old.as_seen.velocity_in_map;
  track.covariance.vv = kSpeedStd * kSpeedStd;
  track.radius_m = old.as_seen.radius_m;
  track.hits += old.as_seen.hits;
  track.moving = true;
  track.position_in_map =
      track.position_in_map - track.velocity_in_map * newcomer.estimate.late_by(newcomer.estimate.late_s);
  newcomer.estimate.as_seen = track;
  newcomer.estimate.filter = ImmFilter(track);
  newcomer.appearance.arc_m = old.arc_m;
  newcomer.existence.born = old.born;
  return true;
}

}  // namespace jaywalk
