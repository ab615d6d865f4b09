#pragma once
// Describes in words where a run waited, for how long and for which mover.
#include <string>
#include <vector>

#include "hal/types/geometry.h"

namespace jaywalk {

/// Stops of 3 s and more, with the body that came nearest meanwhile.
class Waits {
 public:
  /// The robot stood there from then on for so long; shorter ones are left out. `cause` in words.
  void add(double from_s, double for_s, const Pose2& map_from_robot, const std::string& cause);
  /// A body as it was tracked; times in any order.
  void note(double t_s, unsigned id, Vec2 position_in_map, Vec2 velocity_in_map);
  /// A line a wait, the longest of them; empty: there was none.
  [[nodiscard]] std::string words() const;
  [[nodiscard]] bool any() const { return !waits_.empty(); }

 private:
  struct Wait {
    double from_s, for_s;
    Vec2 where;
    std::string cause;
    double nearest_m;
    unsigned id = 0;
    double speed_mps = 0.0;
  };
  std::vector<Wait> waits_;
};

}  // namespace jaywalk
