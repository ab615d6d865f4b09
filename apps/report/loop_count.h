#pragma once
// Loops: full turns of the robot on little way or in little time, and the stretches of a run they take.
#include <deque>
#include <vector>

#include "hal/types/geometry.h"

namespace jaywalk {

/// A stretch of a run.
struct Episode {
  double from_s = 0.0, to_s = 0.0;
};

/// A loop is a net turn by 340 degrees within 10 m of way, or within 60 s, whatever the plan was meanwhile.
class LoopCount {
 public:
  /// A new goal begins anew: a turn back to another goal is none.
  void add(double t_s, const Pose2& pose, Vec2 goal);
  [[nodiscard]] const std::vector<Episode>& loops() const { return loops_; }

 private:
  /// Turn of the robot, rad, over the last `span` of a quantity that only grows (way or time).
  class Window {
   public:
    Window(double span, double piece) : span_(span), piece_(piece) {}
    void clear() { pieces_.clear(); }
    void add(double at, double t_s, double turned_rad);
    /// The last moment since which the robot has turned by a loop; NaN: there is none.
    [[nodiscard]] double loop_since_s(double turned_rad) const;

   private:
    /// Turns while the quantity grew by `piece_`: at the least and at the most, and when these were.
    struct Piece {
      double at, least_rad, most_rad, least_s, most_s;
    };
    double span_, piece_;
    std::deque<Piece> pieces_;
  };

  bool begun_ = false;
  Pose2 last_;
  Vec2 goal_;
  double way_m_ = 0.0, turned_rad_ = 0.0;
  Window by_way_{10.0, 0.05}, by_time_{60.0, 0.2};
  std::vector<Episode> loops_;
};

}  // namespace jaywalk
