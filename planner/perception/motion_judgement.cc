#include "planner/perception/motion_judgement.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

constexpr double kMovingMps = 0.15;  // slower than this is noise of the legs' mean
constexpr double kStoppedMps = 0.10;
constexpr double kSpeedSigmas = 3.0;
constexpr double kGoneM = 0.25;  // from the anchor: half of a step, more than a person's swaying
constexpr double kGoneSigmas = 3.0;
constexpr std::uint32_t kFewestHits = 4;
constexpr Duration kSlowFor = duration_from_seconds(1.0);
constexpr Duration kSettleAfter = duration_from_seconds(1.2);
constexpr Duration kAnchorHolds = duration_from_seconds(3.0);

void anchor_here(Body& body, Time now) {
  body.anchor_in_map = body.track.position_in_map;
  body.still_since = now;
}

bool sets_out(const Body& body) {
  const Track& t = body.track;
  const double speed = norm(t.velocity_in_map);
  const double gone = distance(t.position_in_map, body.anchor_in_map);
  return t.hits >= kFewestHits && speed > std::max(kMovingMps, kSpeedSigmas * std::sqrt(t.covariance.vv)) &&
         gone > std::max(kGoneM, kGoneSigmas * std::sqrt(t.covariance.pp));
}

void judge_mover(Body& body, Time now) {
  if (norm(body.track.velocity_in_map) > kStoppedMps) {
    body.slow_since = kNever;
    return;
  }
  if (body.slow_since == kNever) body.slow_since = now;
  if (now - body.slow_since < kSlowFor) return;
  body.track.moving = false;
  body.slow_since = kNever;
  anchor_here(body, now);
}

void judge_stander(Body& body, Time now) {
  if (sets_out(body)) {
    body.track.moving = true;
    body.settled = false;
    return;
  }
  const Duration stood = now - body.still_since;
  if (stood > kSettleAfter) body.settled = true;
  if (stood > kAnchorHolds) anchor_here(body, now);  // creeping is not walking
}

}  // namespace

void judge_motion(Body& body, Time now) noexcept {
  if (body.given) return;
  if (body.track.moving) {
    judge_mover(body, now);
  } else {
    judge_stander(body, now);
  }
}

}  // namespace jaywalk
