#include "planner/perception/absence.h"

#include <algorithm>

namespace jaywalk {
namespace {

constexpr double kUnseenForS = 2.0;           // a hidden one is believed in this long, or as long as it was seen
constexpr double kWalksUnseenForS = 1.0;      // who walks; after that he may have turned or stopped: HiddenWalkers
constexpr double kTentativeUnseenForS = 0.6;  // anyone: dark cloth returns nothing for half a second

}  // namespace

bool gone(const Body& body, Time now) noexcept {
  const double unseen_s = to_seconds(now - body.track.last_seen);
  if (body.given) return unseen_s > kGivenUnseenForS;
  if (body.looked_through_s > kLookedThroughForS) return true;
  if (!body.confirmed()) return unseen_s > kTentativeUnseenForS;
  const double known_s = to_seconds(body.track.last_seen - body.born);
  const double longest_s = body.track.moving ? kWalksUnseenForS : kUnseenForS;
  return unseen_s > std::clamp(known_s, kTentativeUnseenForS, longest_s);
}

}  // namespace jaywalk
