#pragma once
#include <array>
#include <cstddef>

#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {

/// How well a body's last places lie on one straight walk of constant speed.
struct StraightWalk {
  std::size_t places = 0;
  double length_m = 0.0;    ///< of the fitted walk, from the oldest place to the newest
  double duration_s = 0.0;  ///< from the oldest place to the newest
  double explained = 0.0;   ///< share of the places' scatter that the walk explains, in [0, 1]; 0: nothing to explain
};

/// Where a body was last seen, unfiltered. A filter follows whatever it is fed; the places themselves tell a walk from
/// a cluster that hops between the legs of two chairs: of one hop in the middle, a straight walk explains 75 %.
class RecentPath {
 public:
  void add(Time when, Vec2 where_in_map) noexcept;
  void clear() noexcept { count_ = 0; }
  /// Least squares over the remembered places, x and y against time.
  [[nodiscard]] StraightWalk fit() const noexcept;

 private:
  struct Place {
    Time when = kNever;
    Vec2 where;
  };
  static constexpr std::size_t kRemembered = 10;

  std::array<Place, kRemembered> places_{};
  std::size_t count_ = 0;  ///< ever added
};

}  // namespace jaywalk
