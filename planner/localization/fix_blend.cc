#include "planner/localization/fix_blend.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

constexpr double kFarthestM = 1e7;        // a quarter of the way round the Earth
constexpr double kMostTurnedRad = 100.0;  // whole turns may be in it

}  // namespace

bool is_place(const Pose2& p) noexcept {
  return std::fabs(p.x) <= kFarthestM && std::fabs(p.y) <= kFarthestM && std::fabs(p.heading) <= kMostTurnedRad;
}

PoseBelief blended(const PoseBelief& predicted, const OutsideFix& fix) noexcept {
  const double position_var = std::max(fix.position_std_m * fix.position_std_m, kLeastPositionVar);
  const double heading_var = std::max(fix.heading_std_rad * fix.heading_std_rad, kLeastHeadingVar);
  const Symmetric3 information = diagonal(1.0 / position_var, 1.0 / position_var, 1.0 / heading_var);
  const Symmetric3 covariance = inverse(inverse(predicted.covariance) + information);
  const Row3 by = covariance * (information * offset(predicted.map_from_robot, fix.map_from_robot));
  return {moved(predicted.map_from_robot, by), covariance};
}

}  // namespace jaywalk
