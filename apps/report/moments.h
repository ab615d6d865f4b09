#pragma once
// Describes in words where a run waited or turned round, when, for how long and for which mover.
#include <string>
#include <vector>

#include "hal/types/geometry.h"

namespace jaywalk {
/// Moments of a run, each with the body that came nearest meanwhile.
class Moments {
 public:
  /// The robot was there from then on for so long; `what` in words, or empty.
  void add(double from_s, double for_s, Vec2 position_in_map, const std::string& what);
  /// A body as it was tracked; times in any order.
  void note(double t_s, unsigned id, Vec2 position_in_map, Vec2 velocity_in_map);
  /// `title` and a line each, the longest of them; empty: there was none.
  [[nodiscard]] std::string words(const std::string& title) const;
  [[nodiscard]] bool any() const { return !moments_.empty(); }

 private:
  struct Moment {
    double from_s, for_s;
    Vec2 where;
    std::string what;
    double nearest_m;
    unsigned id = 0;
    double speed_mps = 0.0;
  };
  std::vector<Moment> moments_;
};

}  // namespace jaywalk
