#pragma once
#include "hal/types/geometry.h"
#include "planner/planner.h"

namespace jaywalk {

/// Where a robot is to go, and which way it looks there.
struct Way {
  const Path& places;             ///< in the map, m
  const Path* looking = nullptr;  ///< unit vectors, one a place; null: along the path, and at its begin as it does now

  /// The way that it looks at place `k` of a way that is not empty, `gone_m` after it was at `robot`.
  [[nodiscard]] Vec2 looking_at(std::size_t k, double gone_m, const Pose2& robot) const noexcept;
};

}  // namespace jaywalk
