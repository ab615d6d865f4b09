#pragma once
#include "hal/types/robot_model.h"
#include "planner/motion/body_map.h"
#include "planner/planner.h"

namespace jaywalk {

/// As good as not driven at all.
[[nodiscard]] bool at_rest(const Twist2& twist) noexcept;

/// Rolls a body out from a pose and what it is driven at, and looks whether its outline keeps clear of
/// what a map has. Thread: the loop's.
struct BodyAhead {
  const BodyMap& map;
  const MotionLimits& limits;
  Pose2 map_from_robot;
  Twist2 driven;

  /// Along the path, which is not empty, with the follower's own steering and at most at `most_mps`: with `margin_m`
  /// all the way, or where there is less from the start no less, for 1.6 m or 8 s. Does not turn on the spot into what
  /// it has not seen, nor swing its rear there.
  [[nodiscard]] bool follows(const Path& path, double most_mps, double margin_m) const noexcept;
  /// On the arc that it is on, or turning on the spot, slowing down within comfort until it stands: 5 cm off
  /// everything.
  [[nodiscard]] bool stops_in_time() const noexcept;
};

}  // namespace jaywalk
