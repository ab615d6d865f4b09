#pragma once
// What a scan says of a place: does something stand there, do beams pass over it, or is it out of sight?
#include <cstdint>

#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"
#include "planner/scan/scan_points.h"

namespace jaywalk {

enum class Sight : std::uint8_t {
  kUnseen,   ///< behind something, outside the sweep, or the beam there was not measured
  kThere,    ///< a beam ends there
  kThrough,  ///< beams pass over it
  kEmpty,    ///< none ends there, and some find nothing in a reach that is well beyond it: most likely as kThrough
};

/// Looks at places in a scan of a robot that moves with `twist` while the sweep takes its time.
class LineOfSight {
 public:
  /// `scan` outlives this. `map_from_robot` is the pose at its stamp.
  LineOfSight(const LaserScan& scan, const Pose2& map_from_robot, const Pose2& robot_from_laser, const Twist2& twist);

  /// At the beams that come within `tolerance_m` of the place, as seen from the laser. One that ends within
  /// `tolerance_m` of its distance shows that something is there; of the others all must go on beyond it, or find
  /// nothing. `but` are not asked: beams that end on something beside the place that is known.
  [[nodiscard]] Sight at(Vec2 place_in_map, double tolerance_m, const BeamRun& but = {}) const noexcept;

 private:
  /// A place as the laser sees it: how far off, and at which beam (a real number; beam_count and more: outside).
  struct Bearing {
    double away_m = 0.0, beam = 0.0;
  };
  [[nodiscard]] Bearing bearing(Vec2 place_in_map, double after_s) const noexcept;

  const LaserScan& scan_;
  Pose2 map_from_robot_, robot_from_laser_;
  Twist2 twist_;
  double beam_s_;
  Sweep sweep_;
  Transform2 laser_from_map_;  ///< at the stamp
};

}  // namespace jaywalk
