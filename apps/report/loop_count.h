#pragma once
// Loops: full turns on little way that brought the robot no nearer to its goal.
#include <deque>
#include <limits>
#include <vector>

#include "hal/types/geometry.h"

namespace jaywalk {

/// A loop is a turn by 2 pi, net, within 6 m of way during which the time to go was never less than before.
class LoopCount {
 public:
  /// `to_go_s`: at the controller's plan, from here; infinite where no way is known.
  void add(double t_s, const Pose2& pose, Vec2 goal, double to_go_s);
  /// When each was complete, s.
  [[nodiscard]] const std::vector<double>& loops_at_s() const { return loops_at_s_; }

 private:
  static constexpr double kWithin_m = 6.0, kPiece_m = 0.05;
  static constexpr double kGetsOn_s = 0.5;  ///< a fall of the least time to go that is more than noise

  /// A piece of the way, and how far the robot was turned there, at least and at most.
  struct Piece {
    double way_m, least_rad, most_rad;
  };
  void begin_at(double way_m);

  bool begun_ = false;
  Pose2 last_;
  Vec2 goal_;
  double way_m_ = 0.0, turned_rad_ = 0.0;
  double least_to_go_s_ = std::numeric_limits<double>::infinity();
  std::deque<Piece> pieces_;  ///< since the least time to go was reached, kWithin_m at most
  std::vector<double> loops_at_s_;
};

}  // namespace jaywalk
