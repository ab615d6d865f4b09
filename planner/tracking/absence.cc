#include "planner/tracking/absence.h"

#include <algorithm>

namespace jaywalk {
namespace {

constexpr double kUnseenForS = 2.0;  // a hidden one is believed in this long, or as long as it was seen

}  // namespace

bool gone(const Body& body, Time now) noexcept {
  const double unseen_s = to_seconds(now - body.track.last_seen);
  if (body.given) return unseen_s > kForeseenS;
  if (body.looked_through_s > kLookedThroughForS) return true;
  if (!body.confirmed()) return unseen_s > kTentativeS;
  const double known_s = to_seconds(body.track.last_seen - body.born);
  const double longest_s = body.track.moving ? kForeseenS : kUnseenForS;
  return unseen_s > std::clamp(known_s, kTentativeS, longest_s);
}

}  // namespace jaywalk
