#pragma once
// Fixes from outside.
#include <cstdint>

#include "hal/types/outside_fix.h"
#include "planner/localization/pose_belief.h"

namespace jaywalk {

/// Variances of a pose that is known as exactly as any can be: no map of 10 cm cells places a robot better, and nobody
/// puts it anywhere more exactly.
inline constexpr double kLeastPositionVar = 0.005 * 0.005;  // m2
inline constexpr double kLeastHeadingVar = 0.002 * 0.002;   // rad2

/// Covariance of a fix that is_usable(), in the map.
[[nodiscard]] Eigen::Matrix3d covariance_of(const OutsideFix& fix) noexcept;

/// What is believed after a fix, each part by its variance. The fix's pose is as is_usable() wants it.
[[nodiscard]] PoseBelief blended(const PoseBelief& predicted, const OutsideFix& fix) noexcept;

/// Whether a robot may be there, known so well; false for NaN. Farther than 10,000 km or turned by more than 100 rad is
/// a mistake, and what that would turn the robot by no number can hold.
[[nodiscard]] bool is_usable(const OutsideFix& fix) noexcept;

/// Tells fixes that belong to what is believed from those that do not: one alone is a mistake of the system outside,
/// three that tell the same place, as the robot moved meanwhile, are a mistake of ours.
class FixGate {
 public:
  enum class Verdict : std::uint8_t { kBlend, kPassOver, kTake };
  /// `odom_from_robot`: when the fix was taken.
  [[nodiscard]] Verdict judge(const PoseBelief& predicted, const OutsideFix& fix,
                              const Pose2& odom_from_robot) noexcept;

 private:
  Pose2 map_from_odom_;  ///< as the last that was passed over has it
  int agreeing_ = 0;
};

}  // namespace jaywalk
