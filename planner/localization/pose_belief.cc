#include "planner/localization/pose_belief.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {
// What the matcher's window holds (correlative_search.cc: 0.4 m and 0.42 rad to each side), as standard deviations: a
// third of a second.
constexpr double kMostPositionVar = 0.3 * 0.3, kMostHeadingVar = 0.3 * 0.3;

constexpr double kMostTurnedRad = 100.0;  // whole turns may be in it
constexpr double kGateNis = 16.3;         // chi-squared of three, 99.9 % (Bar-Shalom and others 2001, table 1.5.4-1)
constexpr int kEnough = 3;

}  // namespace

double nis(const Pose2& from, const Pose2& to, const Eigen::Matrix3d& covariance) noexcept {
  const Eigen::Vector3d innovation = offset(from, to);
  return innovation.dot(covariance.inverse() * innovation);
}

void PoseDoubt::coasted(const Coasting::Step& step) noexcept {
  position_var_ += step.metres_std * step.metres_std;
  heading_var_ += step.radians_std * step.radians_std;
  doubtful_ = doubtful_ || position_var_ > kMostPositionVar || heading_var_ > kMostHeadingVar;
}

Eigen::Matrix3d covariance_of(const OutsideFix& fix) noexcept {
  const double position_var = std::max(fix.position_std_m * fix.position_std_m, kLeastPositionVar);
  return diagonal(position_var, position_var, std::max(fix.heading_std_rad * fix.heading_std_rad, kLeastHeadingVar));
}

bool is_usable(const OutsideFix& fix) noexcept {
  const Pose2& p = fix.map_from_robot;
  return std::fabs(p.x) <= kFarthestFixM && std::fabs(p.y) <= kFarthestFixM && std::fabs(p.heading) <= kMostTurnedRad &&
         fix.position_std_m >= 0.0 && fix.position_std_m <= kFarthestFixM && fix.heading_std_rad >= 0.0 &&
         fix.heading_std_rad <= kMostTurnedRad;
}

FixGate::Verdict FixGate::judge(const PoseBelief& predicted, bool in_doubt, const OutsideFix& fix,
                                const Pose2& odom_from_robot) noexcept {
  const Eigen::Matrix3d doubt = covariance_of(fix);
  if (!in_doubt && nis(predicted.map_from_robot, fix.map_from_robot, predicted.covariance + doubt) < kGateNis) {
    agreeing_ = 0;
    return Verdict::kBlend;
  }
  const Pose2 as_the_last_has_it = map_from_odom_ * odom_from_robot;
  const bool agrees = agreeing_ > 0 && nis(as_the_last_has_it, fix.map_from_robot, doubt + doubt) < kGateNis;
  agreeing_ = agrees ? agreeing_ + 1 : 1;
  map_from_odom_ = fix.map_from_robot * inverse(odom_from_robot);
  if (agreeing_ < kEnough) return Verdict::kPassOver;
  agreeing_ = 0;
  return Verdict::kTake;
}

PoseBelief blended(const PoseBelief& predicted, const OutsideFix& fix) noexcept {
  const Eigen::Matrix3d information = covariance_of(fix).inverse();
  const Eigen::Matrix3d covariance = (predicted.covariance.inverse() + information).inverse();
  const Eigen::Vector3d by = covariance * (information * offset(predicted.map_from_robot, fix.map_from_robot));
  return {moved(predicted.map_from_robot, by), covariance};
}

}  // namespace jaywalk
