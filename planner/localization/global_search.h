#pragma once
#include <optional>

#include "planner/localization/correlative_search.h"
#include "planner/mapping/known_map.h"

namespace jaywalk {
/// Where on a map a scan was taken, and how surely.
struct GlobalMatch {
  Pose2 map_from_robot;
  double share = 0.0;          ///< of the points that lie on walls there with no wall before them, 0 to 1
  std::optional<Pose2> other;  ///< the best pose more than a metre or 30 degrees off
  double other_share = 0.0;
};

/// Correlative search over all free cells and headings: which pose puts most of the scan on walls. In steps of 0.2 m
/// and 4 degrees, then about the best in steps of 5 cm and 1 degree. Of these the pose counts at which most points are
/// walls that the laser, `laser_in_robot`, can see: a beam does not pass through a wall (Thrun, Burgard, Fox:
/// Probabilistic Robotics, 2005, 6.3). Seconds for a hall of 50 m: for start-up, it allocates.
[[nodiscard]] GlobalMatch search_everywhere(const KnownMap& map, const MatchSample& sample, Vec2 laser_in_robot);

}  // namespace jaywalk
