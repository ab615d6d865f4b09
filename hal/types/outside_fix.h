#pragma once
#include <cstddef>
#include <cstdint>

#include "hal/types/fixed_vector.h"
#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {

inline constexpr std::size_t kMaxObservedMovers = 64;
inline constexpr double kFarthestFixM = 1e7;  ///< from the map's origin: a quarter of the way round the Earth

/// A mover as an outside localisation system sees it.
struct ObservedMover {
  std::uint32_t id = 0;  ///< the system's own, kept from fix to fix
  Vec2 position_in_map;  ///< noisy
  double radius_m = 0.0;
};

/// What a localisation system outside the robot reports (the paper's: "noisy positions").
struct OutsideFix {
  Time stamp = kNever;
  std::uint32_t sequence = 0;  ///< grows by one a fix; 0: none yet
  bool has_pose = false;
  Pose2 map_from_robot;
  double position_std_m = 0.0;
  double heading_std_rad = 0.0;
  double mover_std_m = 0.0;                               ///< of each mover's x and y
  FixedVector<ObservedMover, kMaxObservedMovers> movers;  ///< only those that the system can name
};

}  // namespace jaywalk
