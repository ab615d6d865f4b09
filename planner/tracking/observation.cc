#include <algorithm>
#include <cmath>

#include "hal/types/trig.h"
#include "planner/scan/line_of_sight.h"
#include "planner/tracking/target.h"

namespace jaywalk {
namespace {
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

Observation observation_of(const Detections& detections, std::size_t lead, std::int32_t fellow, double arc_m,
                           bool on_legs) noexcept {
  const Detection& c = detections[lead];
  const double half_m = c.whole() ? c.radius_m : std::max(c.radius_m, arc_m);  // what is hidden is there all the same
  Observation seen{.position_in_map = c.centre_in_map,
                   .late_s = c.late_s,
                   .late_std_s = c.late_std_s,
                   .std_m = kArcStdM + kArcStdPerSpacing * c.spacing_m,
                   .off_std_m = off_std_m(c, arc_m),
                   .radius_m = std::clamp(half_m, kLegsReachM, 0.5 * kWidestBodyM),
                   .in_free_space = c.in_free_space,
                   .outline_in_map = c.outline_in_map,
                   .beams = c.beams,
                   .whole = c.whole(),
                   .hidden_side = c.hidden_side(),
                   .on_wall = c.on_wall,
                   .width_m = distance(c.outline_in_map[0], c.outline_in_map.back()),
                   .spacing_m = c.spacing_m,
                   .was_off = {}};
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
