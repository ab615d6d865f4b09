#include "planner/tracking/occlusion.h"

#include <algorithm>

#include "planner/tracking/tuning.h"

namespace jaywalk {
namespace {
constexpr double kUnseenForS = 2.0;  // an occluded target stays a track for so long, or for as long as it was seen
constexpr double kSpeedStd = 0.1;    // m/s an axis, of one that comes out where it should; by trial, seeds 1 to 6

/// Whether it is one of the targets, standing or about to go on.
bool is_tracked(const StandingPedestrian& pedestrian, const Targets& targets) {
  return std::any_of(targets.begin(), targets.end(), [&](const Target& target) {
    const double within_m = target.estimate.track.moving ? pedestrian.radius_m : kSkinM;
    return target.confirmed() &&
           distance(target.estimate.as_seen.position_in_map, pedestrian.position_in_map) < within_m;
  });
}

bool something_stands(const StandingPedestrian& pedestrian, const EvidenceMap& still) {
  const Vec2 reach{kLegsReachM, kLegsReachM};
  const CellIndex low = still.cell_at(pedestrian.position_in_map - reach);
  const CellIndex high = still.cell_at(pedestrian.position_in_map + reach);
  for (std::int32_t j = low.j; j <= high.j; ++j) {
    for (std::int32_t i = low.i; i <= high.i; ++i) {
      if (!still.occupied({i, j})) continue;
      if (distance(still.surface({i, j}), pedestrian.position_in_map) < kLegsReachM) return true;
    }
  }
  return false;
}

/// No beam passes over its place, and it is not long since it was seen there.
bool may_be_hidden(const StandingPedestrian& pedestrian, const LineOfSight& sight, Time now) {
  const double unseen_s = to_seconds(now - pedestrian.last_seen);
  return unseen_s < kRememberedS && sight.at(pedestrian.position_in_map, kLegsReachM) != Sight::kThrough;
}

/// When something was seen last in its place: a pedestrian that comes into view again is born anew, and may show one
/// leg.
Time last_seen(const StandingPedestrian& pedestrian, const Targets& targets, Time now) {
  Time last = pedestrian.last_seen;
  for (const Target& target : targets) {
    const Track& seen = target.estimate.as_seen;
    if (distance(seen.position_in_map, pedestrian.position_in_map) < kLegsReachM) last = std::max(last, seen.last_seen);
  }
  return std::min(last, now);  // a clock may be set back
}

/// Returns the target as a standing candidate. The target takes over the belief in the candidate at its place.
StandingPedestrian follow(Target& target, const StandingCandidates& before, Time now) {
  const Track& seen = target.estimate.as_seen;
  PedestrianBelief& belief = target.existence.pedestrian;
  const Time still = target.estimate.track.still_since;
  Time since = still == kNever ? now : std::min(now, still);
  for (const StandingPedestrian& one : before) {
    if (distance(one.position_in_map, seen.position_in_map) >= kSkinM) continue;
    since = std::min(since, one.since);
    belief.inherit(one.belief);
  }
  return {seen.position_in_map, target.estimate.track.radius_m, seen.last_seen, since, belief, true};
}

/// Bodies do not overlap: of two pedestrians too near to be two, the one seen last is left, since the earlier's time.
bool is_another(const StandingPedestrian& one, StandingCandidates& others) {
  if (!one.belief.is_pedestrian()) return false;
  for (StandingPedestrian& other : others) {
    if (!other.belief.is_pedestrian() || distance(other.position_in_map, one.position_in_map) >= kSamePedestrianM)
      continue;
    const Time since = std::min(other.since, one.since);
    if (!other.followed && one.last_seen > other.last_seen) other = one;
    other.since = since;
    return true;
  }
  return false;
}

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

void update_standing(Targets& targets, const EvidenceMap& still, const LineOfSight& sight, Time now,
                     StandingCandidates& standing) noexcept {
  const StandingCandidates before = standing;
  StandingCandidates all;
  for (Target& target : targets) {
    if (target.confirmed() && !target.estimate.track.moving) (void)all.push_back(follow(target, before, now));
  }
  for (StandingPedestrian one : before) {
    one.last_seen = last_seen(one, targets, now);
    one.followed = false;
    const bool stays = something_stands(one, still) || may_be_hidden(one, sight, now);
    if (stays && !is_tracked(one, targets) && !is_another(one, all)) (void)all.push_back(one);
  }
  standing.clear();
  for (const bool pedestrians : {true, false}) {
    for (const StandingPedestrian& one : all) {
      if (one.belief.may_be_pedestrian() && one.belief.is_pedestrian() == pedestrians) (void)standing.push_back(one);
    }
  }
}

}  // namespace jaywalk
