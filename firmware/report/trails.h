#pragma once
// Where things went, thinned out for the picture.
#include <cstdint>
#include <map>
#include <vector>

#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {

struct TrailPoint {
  Time t = kNever;
  Vec2 position;
};

/// Where the robot stood.
struct DrivenPose {
  Time t = kNever;
  Pose2 pose;
};

/// One thing's way through the run.
struct Trail {
  std::uint32_t id = 0;
  double radius_m = 0.0;
  bool flagged = false;  ///< of a mover: was forced at some time; of a track: was moving at some time
  std::vector<TrailPoint> points;
};

/// Trails by id; a point is kept when its forerunner is kSpacing old or older.
class TrailBook {
 public:
  static constexpr Duration kSpacing{200'000'000};

  void add(std::uint32_t id, Time t, Vec2 position, double radius_m, bool flag);
  /// In the order of their ids.
  [[nodiscard]] std::vector<Trail> trails() const;

 private:
  std::map<std::uint32_t, Trail> trails_;
};

}  // namespace jaywalk
