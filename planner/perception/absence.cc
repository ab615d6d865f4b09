#include "planner/perception/absence.h"

#include <algorithm>

namespace jaywalk {
namespace {

constexpr double kUnseenForS = 2.0;           // a hidden one is believed in this long, and no longer than it was seen
constexpr double kWalksUnseenForS = 1.0;      // who walks; after that he may have turned or stopped: HiddenWalkers
constexpr double kTentativeUnseenForS = 0.6;  // one not believed yet: dark cloth returns nothing for half a second
constexpr double kGivenUnseenForS = 1.0;      // one from outside, this long after its last report

}  // namespace

bool gone(const Body& body, Time now) noexcept {
  const double unseen_s = to_seconds(now - body.track.last_seen);
  if (body.given) return unseen_s > kGivenUnseenForS;
  if (body.looked_through_s > kLookedThroughForS) return true;
  if (!body.confirmed()) return unseen_s > kTentativeUnseenForS;
  const double known_s = to_seconds(body.track.last_seen - body.born);
  return unseen_s > std::min(body.track.moving ? kWalksUnseenForS : kUnseenForS, known_s);
}

}  // namespace jaywalk
