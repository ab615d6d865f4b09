#include "planner/tracking/given_movers.h"

#include <algorithm>
#include <cmath>

#include "planner/tracking/imm_filter.h"
#include "planner/tracking/target.h"

namespace jaywalk {
namespace {

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

}  // namespace

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

}  // namespace jaywalk
