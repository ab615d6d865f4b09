#pragma once
#include "hal/types/fixed_vector.h"
#include "planner/tracking/target_parts.h"

namespace jaywalk {

/// A track with what the tracker alone needs to know of it.
struct Target {
  Estimate estimate;
  Appearance appearance;
  OnsetHistory onset;
  Existence existence;

  [[nodiscard]] bool confirmed() const { return existence.confirmed(estimate.track); }
  [[nodiscard]] MotionEvidence motion() const { return {estimate, appearance, onset}; }
};

using Targets = FixedVector<Target, kMaxTracks>;

/// A target seen for the first time at `position_in_map`: it may be walking already, 1 m/s an axis.
[[nodiscard]] Target born_at(Vec2 position_in_map, double std_m, double radius_m, Time now, std::uint32_t id) noexcept;

/// From now on it is watched for going away from where it is, and was just seen.
void anchor_here(OnsetHistory& onset, Vec2 position_in_map, const Appearance& seen, const Pose2& map_from_laser,
                 Time now) noexcept;

/// It was `by_m` from where it was taken to be, all the time.
void move_all(Estimate& estimate, OnsetHistory& onset, Vec2 by_m) noexcept;

/// Adds `newcomer`. When there are kMaxTracks already, the one farthest from the robot goes, of those that stand where
/// walls stand if there are any; and that may be the newcomer.
void admit(Targets& targets, const Target& newcomer, Vec2 robot_in_map) noexcept;

}  // namespace jaywalk
