#include "planner/tracking/motion_judgement.h"

#include <utility>

#include "planner/tracking/departure.h"
#include "planner/tracking/steady_walk.h"

namespace jaywalk {
namespace {

constexpr std::uint32_t kWalkedScans = 2;  // in a row: a hop is over by the next scan
// Who turns on the spot walks on. Less than the 5 s in which who stays is to be in the map.
constexpr Duration kSlowFor = duration_from_seconds(4.3);
constexpr Duration kSettleAfter = duration_from_seconds(1.2);

void judge_mover(Body& body, const Surroundings& around, Time now) {
  if (norm(body.track.velocity_in_map) >= kStoppedMps) {
    body.slow_since = kNever;
    return;
  }
  if (body.slow_since == kNever) body.slow_since = now;
  if (now - body.slow_since < kSlowFor) return;
  body.track.moving = false;
  anchor_here(body, around.map_from_laser, now);
  body.still_since = std::exchange(body.slow_since, kNever);  // it has stood here for as long as it was slow
}

void note_departure(Body& body, Departure seen) {
  if (seen == Departure::kNone) {
    body.walked = 0;
  } else {
    body.walked += seen == Departure::kCertain ? kWalkedScans : 1;
  }
}

void judge_stander(Body& body, const Surroundings& around, Time now) {
  if (body.misses == 0) note_departure(body, departure(body, around));
  if (body.walked >= kWalkedScans) {
    body.walked = 0;
    body.track.moving = true;
    body.models.date_back(body.track, body.late_s);
    body.settled = false;
    return;
  }
  const Duration stood = now - body.still_since;
  if (stood > kSettleAfter && distance(body.track.position_in_map, body.anchor_in_map) < kStandsWithinM)
    body.settled = true;
  if (stood > kMayGoOnWithin) anchor_here(body, around.map_from_laser, now);  // creeping is not walking
}

/// Not called moving, and no wall: who goes along beside the robot.
bool came_along(const Body& body) {
  return body.solid() && body.whole && came_to_free_space(body) &&
         distance(body.track.position_in_map, body.anchor_in_map) > 2.0 * kPersonRadiusM;
}

/// As thin as a leg, and stands where nothing stood: the other leg may be behind it.
bool put_a_leg_down(const Body& body) { return body.whole && body.arc_m == 0.0 && came_to_free_space(body); }

bool may_be_somebody(const Body& body) {
  return body.track.moving || (body.confirmed() && (body.on_legs() || came_along(body) || put_a_leg_down(body)));
}

}  // namespace

void judge_motion(Body& body, const Surroundings& around, Time now) noexcept {
  if (body.given) return;
  if (body.track.moving) {
    judge_mover(body, around, now);
  } else {
    judge_stander(body, around, now);
  }
  body.somebody = body.somebody || may_be_somebody(body);
}

}  // namespace jaywalk
