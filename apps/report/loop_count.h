#pragma once
// Loops: full turns of the robot on little way, and the stretches of a run they take.
#include <deque>
#include <vector>

#include "hal/types/geometry.h"

namespace jaywalk {

/// A stretch of a run.
struct Episode {
  double from_s = 0.0, to_s = 0.0;
};

/// A loop is a net turn by 340 degrees within 10 m of way, whatever the plan was meanwhile and however long it took. On
/// a longer way a turn may be the way itself, as on map 4, where an alley ends and another leads on.
class LoopCount {
 public:
  /// A new goal begins anew: a turn back to another goal is none.
  void add(double t_s, const Pose2& pose, Vec2 goal);
  [[nodiscard]] const std::vector<Episode>& loops() const { return loops_; }

 private:
  /// Turns, rad, while the way grew by kPiece_m: at the least and at the most, and when these were.
  struct Piece {
    double way_m, least_rad, most_rad, least_s, most_s;
  };
  /// The last moment since which the robot has turned by a loop; NaN: there is none.
  [[nodiscard]] double loop_since_s() const;

  bool begun_ = false;
  Pose2 last_;
  Vec2 goal_;
  double way_m_ = 0.0, turned_rad_ = 0.0;
  std::deque<Piece> pieces_;  ///< of the last 10 m
  std::vector<Episode> loops_;
};

}  // namespace jaywalk
