#include "planner/tracking/target.h"

#include <algorithm>
#include <cmath>

#include "hal/types/trig.h"
#include "planner/scan/line_of_sight.h"
#include "planner/tracking/tuning.h"

namespace jaywalk {
namespace {

constexpr double kFirstSpeedStd = 1.0;  // m/s an axis: people walk at 1.3 m/s

/// Whether `a` is to go rather than `b` where there is no room for both.
bool matters_less(const Target& a, const Target& b, Vec2 robot) {
  if (a.appearance.on_wall != b.appearance.on_wall) return a.appearance.on_wall;
  return distance(a.estimate.track.position_in_map, robot) > distance(b.estimate.track.position_in_map, robot);
}

constexpr double kGivenAccelStd = 0.5;  // m/s2: the paper's movers keep their speed and seldom turn
constexpr double kFreeGain = 0.3;       // of the running mean of how free the ground under a target was
constexpr double kNoiseGain = 0.075;    // a scan: a second teaches how noisy a target is
constexpr double kMostNoise = 25.0;     // times the variance expected, or as small a part of it
constexpr double kMostNis = 16.0;       // that one scan teaches: more is another's position

/// Steers the measurement noise to where the normalised innovation squared is 2 on average, whatever the target is: a
/// disc is seen to a centimetre, a pair of legs sways.
void learn_noise(double& noise, double nis) {
  const double wanted = 0.5 * std::min(nis, kMostNis) - 1.0;
  noise = std::clamp(noise * (1.0 + kNoiseGain * wanted), 1.0 / kMostNoise, kMostNoise);
}

void learn_size(Appearance& appearance, double& radius_m, const Observation& seen) {
  radius_m += kMeanGain * (seen.radius_m - radius_m);
  appearance.legs_share += kMeanGain * ((seen.two_legs ? 1.0 : 0.0) - appearance.legs_share);
  double& arc_m = appearance.arc_m;
  if (appearance.on_legs()) arc_m = 0.0;
  if (seen.arc_m > 0.0) arc_m += (arc_m > 0.0 ? kMeanGain : 1.0) * (seen.arc_m - arc_m);
}

/// Where both legs are seen their middle may be known to a centimetre. That says nothing of one leg alone: for a step
/// it stands on the ground, and a filter that believed it so well would stop the pedestrian.
double noise_of(double noise, const Observation& seen) { return seen.lone_leg ? std::max(noise, 1.0) : noise; }

void correct_track(Estimate& estimate, double& noise, const Observation& seen) {
  Track& track = estimate.track;
  const double late_s = estimate.late_by(seen.late_s);
  const double smeared_m = norm(track.velocity_in_map) * estimate.late_by(seen.late_std_s);
  const double std_m = seen.std_m * std::sqrt(noise_of(noise, seen)) + smeared_m;
  track.nis = gate_distance2(track, seen.position_in_map, std_m, late_s);
  learn_noise(noise, track.nis);
  estimate.filter.correct(track, seen.position_in_map, std_m, late_s);
}

constexpr double kLeastStdM = 1e-3;  // a filter that is told of no noise divides by none
constexpr double kMostStdM = 1e3;    // a system that knows no more knows nothing
constexpr double kWidestM = 1.0;     // by its radius

/// False for NaN.
bool usable(const ObservedMover& mover) {
  const Vec2 p = mover.position_in_map;
  return std::fabs(p.x) <= kFarthestFixM && std::fabs(p.y) <= kFarthestFixM && mover.radius_m > 0.0 &&
         mover.radius_m <= kWidestM;
}

Target first_report(const ObservedMover& mover, double std_m, Time stamp, std::uint32_t id) {
  Target target = born_at(mover.position_in_map, std_m, mover.radius_m, stamp, id);
  target.existence.given = true;
  target.existence.given_id = mover.id;
  target.estimate.track.moving = true;
  return target;
}

void report_again(Target& target, const ObservedMover& mover, double std_m, Time stamp) {
  predict_to(target.estimate, true, stamp);
  Track& track = target.estimate.track;
  const double late_s = to_seconds(track.stamp - stamp);  // it has walked on since
  const Vec2 place = mover.position_in_map + track.velocity_in_map * late_s;
  correct(track.position_in_map, track.velocity_in_map, track.covariance, place, std_m * std_m);
  target.estimate.track.hits += 1;
  target.estimate.track.last_seen = stamp;
}

// Standard deviations of where the body's centre is, an axis. One leg lies up to a quarter of a stride off the middle,
// and does so for several scans, for which it counts double: by trial (at 0.17 twice as many things move where
// nobody is, at 0.25 fewer walkers are found); two together have innovations of 2 of real people. An arc's ends lie
// somewhere between beams; an arc's are what simulated discs turned out to have.
constexpr double kOneLegStdM = 0.21, kTwoLegsStdM = 0.07;
constexpr double kDeeperM = 0.08;  // than a leg that hides the other one: half of what is from one to the other
constexpr double kArcStdM = 0.0035, kArcStdPerSpacing = 0.17;
// Of what is hidden of a body whose width is known: with it innovations are 2 on average, all bodies together.
constexpr double kHiddenStdPerM = 0.05;
// Of a middle by both sides, each of which lies anywhere within half a step beyond its last beam: two of step^2 / 12,
// halved twice.
constexpr double kSidesVarPerSpacing2 = 1.0 / 24.0;
constexpr double kRadiusStdM = 0.126;  // of a radius anywhere from 0.1 to 0.5 m about a person's

double off_std_m(const Detection& c, double arc_m) {
  const double radius_std = c.whole() || arc_m > 0.0 ? 0.0 : kRadiusStdM;
  return std::sqrt(kSidesVarPerSpacing2 * c.spacing_m * c.spacing_m + radius_std * radius_std);
}

/// The middle of a disc of `arc_m` one side of which is hidden, by the side that is seen.
Vec2 middle_by_a_side(const Detection& c, double arc_m) {
  const double mean_bearing = c.hidden_side() > 0 ? c.low_rad : c.high_rad;
  const SeenDisc disc = seen_side(arc_m, c.low_rad + c.high_rad, c.mean_range_m, mean_bearing);
  const Vec2 laser = c.mean_in_map - c.along * c.mean_range_m;
  const double aside = disc.bearing_rad - mean_bearing;
  return laser + (c.along * cos(aside) + c.high_side * (c.hidden_side() * sin(aside))) * disc.range_m;
}

/// Moves what was taken for the middle of the detection to the middle of its body, which is `arc_m` from the side that
/// is seen, and no farther, were more of it in view: what comes into view of a standing target must not move it. Hidden
/// on both sides, it may be either way.
void be_told_by_a_side(const Detection& c, double arc_m, Observation& seen) {
  const double hidden = arc_m - c.radius_m;
  seen.std_m += (c.hidden_side() == 0 ? 1.0 : kHiddenStdPerM) * std::max(0.0, hidden);
  if (c.hidden_side() == 0) return;
  seen.position_in_map = middle_by_a_side(c, arc_m);
  if (hidden < 0.0)
    seen.radius_m = std::min(seen.radius_m - hidden, 0.5 * kWidestBodyM);  // what is seen reaches so far
}

void be_legs(const Detections& detections, std::size_t lead, std::int32_t fellow, Observation& seen) {
  const Detection& c = detections[lead];
  const bool alone = fellow < 0 && c.one_leg();
  seen.lone_leg = alone;
  seen.std_m = alone ? kOneLegStdM : kTwoLegsStdM;
  seen.radius_m = kPersonRadiusM;
  if (fellow >= 0) {
    seen.two_legs = c.whole() && detections[static_cast<std::size_t>(fellow)].whole();
    seen.position_in_map = (c.centre_in_map + detections[static_cast<std::size_t>(fellow)].centre_in_map) * 0.5;
    seen.late_s = (c.late_s + detections[static_cast<std::size_t>(fellow)].late_s) * 0.5;
  } else if (alone && c.whole()) {
    seen.position_in_map = c.centre_in_map + c.along * kDeeperM;
  }
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

void anchor_here(Target& target, const Pose2& map_from_laser, Time now) noexcept {
  target.onset.anchor_in_map = target.position();
  target.onset.anchor_outline = target.appearance.outline_in_map;
  target.onset.anchor_in_laser = inverse(map_from_laser) * target.position();
  target.onset.anchored = now;
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

double step_seconds(Time from, Time to) noexcept {
  if (from == kNever || to <= from) return 0.0;
  return std::min(to_seconds(to - from), kForeseenS);
}

void predict_to(Estimate& estimate, bool given, Time stamp) noexcept {
  Track& track = estimate.track;
  const double dt = step_seconds(track.stamp, stamp);
  if (given) {
    predict(track, dt, kGivenAccelStd);
  } else {
    estimate.filter.predict(track, dt);
  }
  // A clock set back by less than a second goes on from there: filters that waited for it would take what they see as
  // seen at once.
  track.stamp = given ? std::max(track.stamp, stamp) : stamp;
}

void note_seen(Estimate& estimate, Appearance& appearance, const Observation& seen) noexcept {
  estimate.off_std_m = seen.off_std_m;
  estimate.late_s = seen.late_s;
  static_cast<Look&>(appearance) = seen;
}

void update_with(Target& target, const Observation& seen, const Pose2& map_from_laser, Time now) noexcept {
  auto& [estimate, appearance, onset, existence] = target;
  Track& track = estimate.track;
  move_all(estimate, onset, seen.was_off);
  correct_track(estimate, appearance.noise, seen);
  learn_size(appearance, track.radius_m, seen);
  track.hits += 1;
  existence.misses = 0;
  existence.looked_through_s = 0.0;
  const bool after_a_gap = to_seconds(now - track.last_seen) > kPauseS;
  if (after_a_gap) onset.positions.clear();
  track.last_seen = now;
  onset.positions.add(now, {seen.position_in_map, seen.width_m, seen.spacing_m, seen.whole});
  note_seen(estimate, appearance, seen);
  if (after_a_gap && !track.moving)  // what stood elsewhere may be another
    anchor_here(target, map_from_laser, now);
  onset.free_share += std::max(kFreeGain, 1.0 / track.hits) * ((seen.in_free_space ? 1.0 : 0.0) - onset.free_share);
  estimate.as_seen = track;
}

void take_given(const OutsideFix& fix, Vec2 robot_in_map, Targets& targets, std::uint32_t& last_id) noexcept {
  if (!(fix.mover_std_m <= kMostStdM) || fix.stamp == kNever) return;  // NaN too
  const double std_m = std::max(fix.mover_std_m, kLeastStdM);
  for (const ObservedMover& mover : fix.movers) {
    if (!usable(mover)) continue;
    const auto known = std::find_if(targets.begin(), targets.end(), [&](const Target& b) {
      return b.existence.given && b.existence.given_id == mover.id;
    });
    if (known == targets.end()) {
      admit(targets, first_report(mover, std_m, fix.stamp, ++last_id), robot_in_map);
    } else {
      report_again(*known, mover, std_m, fix.stamp);
    }
  }
}

Observation observation_of(const Detections& detections, std::size_t lead, std::int32_t fellow, double arc_m,
                           bool on_legs) noexcept {
  const Detection& c = detections[lead];
  const double half_m = c.whole() ? c.radius_m : std::max(c.radius_m, arc_m);  // what is hidden is there all the same
  Observation seen;
  static_cast<Look&>(seen) = {c.outline_in_map, c.beams, c.whole(), c.hidden_side(), c.on_wall};
  seen.position_in_map = c.centre_in_map;
  seen.late_s = c.late_s;
  seen.late_std_s = c.late_std_s;
  seen.std_m = kArcStdM + kArcStdPerSpacing * c.spacing_m;
  seen.off_std_m = off_std_m(c, arc_m);
  seen.radius_m = std::clamp(half_m, kLegsReachM, 0.5 * kWidestBodyM);
  seen.in_free_space = c.in_free_space;
  seen.width_m = distance(c.outline_in_map[0], c.outline_in_map.back());
  seen.spacing_m = c.spacing_m;
  if (seen.whole) {
    if (!c.leg() && !on_legs) seen.arc_m = c.radius_m;
  } else {
    be_told_by_a_side(c, arc_m > 0.0 ? std::max(arc_m, c.radius_m) : kPersonRadiusM, seen);
  }
  const bool part_of_more = !seen.whole && arc_m > 0.0;
  if ((c.leg() || on_legs) && !part_of_more && !c.behind_more) be_legs(detections, lead, fellow, seen);
  return seen;
}

Vec2 off_by_one_side(const Detection& c, int hidden_side) noexcept {
  if (hidden_side == 0) return {};
  return (c.high_side * hidden_side + c.along * kArcMean) * (c.radius_m - kPersonRadiusM);
}

}  // namespace jaywalk
