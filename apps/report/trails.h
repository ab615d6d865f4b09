#pragma once
// Where things went, thinned out for the picture. A run of days keeps as much as one of hours: where there are too many
// points, the time between them doubles.
#include <cstddef>
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

/// The robot's own way: a pose every 0.2 s; where there would be more than kMostPoses (an hour), twice as long, and so
/// on.
class DrivenWay {
 public:
  static constexpr Duration kSpacing{200'000'000};
  static constexpr std::size_t kMostPoses = 18'000;

  void add(Time t, const Pose2& pose);
  [[nodiscard]] const std::vector<DrivenPose>& poses() const { return poses_; }

 private:
  Duration spacing_ = kSpacing;
  std::vector<DrivenPose> poses_;
};

/// One thing's way through the run.
struct Trail {
  std::uint32_t id = 0;
  double radius_m = 0.0;
  bool flagged = false;  ///< of a mover: was forced at some time; of a track: was moving at some time
  std::vector<TrailPoint> points;
};

/// Trails by id; a point is kept when its forerunner is 0.2 s old or older. Where there would be more than kMostPoints,
/// that time doubles, and so on; where there would be more than kMostTrails, the half that ended first is forgotten.
class TrailBook {
 public:
  static constexpr std::size_t kMostPoints = 200'000, kMostTrails = 4'000;

  void add(std::uint32_t id, Time t, Vec2 position, double radius_m, bool flag);
  /// In the order of their ids.
  [[nodiscard]] std::vector<Trail> trails() const;

 private:
  void thin_out();
  void forget_oldest();

  Duration spacing_ = DrivenWay::kSpacing;
  std::size_t points_ = 0;
  std::map<std::uint32_t, Trail> trails_;
};

}  // namespace jaywalk
