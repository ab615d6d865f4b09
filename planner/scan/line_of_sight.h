#pragma once
// Lines of sight in a scan, and the raw scans of the last second that they are asked of.
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"
#include "planner/scan/scan_points.h"

namespace jaywalk {
/// What a scan says of a place.
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
  LineOfSight(const LaserScan& scan, const Pose2& map_from_robot, const Pose2& robot_from_laser, const Twist2& twist)
      : scan_(scan),
        map_from_robot_(map_from_robot),
        robot_from_laser_(robot_from_laser),
        twist_(twist),
        beam_s_(beam_interval_s(scan, twist)),
        sweep_(sweep_of(scan)),
        laser_from_map_(inverse(map_from_robot * robot_from_laser)) {}

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

/// A scan and where its laser was then, in the map. The scan outlives it.
struct SeenFrom {
  const LaserScan* scan = nullptr;
  Pose2 map_from_laser{};
};

// The part of a disc that a laser sees: where its centre lies behind the mean of its points.
//
// Beams at equal angles t from the centre's bearing end on a disc of radius r, its centre d away, at the ranges
// d cos t - sqrt(r^2 - d^2 sin^2 t). Their points' mean from t0 to t1, along that bearing, is d (F(t1) - F(t0)) / (t1 -
// t0) with s = r / d and 2 F(t) = t + sin t cos t - sin t sqrt(s^2 - sin^2 t) - s^2 asin(sin t / s).

/// The mean of the half circle that parallel beams see lies so much of the radius before its centre: a disc far off.
inline constexpr double kArcMean = kPi / 4.0;

/// A disc as a laser sees it.
struct SeenDisc {
  double range_m = 0.0;      ///< of its centre, from the laser
  double radius_m = 0.0;     ///< of the disc
  double bearing_rad = 0.0;  ///< of its centre, from the side that is seen
};

/// The disc that is seen whole, under `angle_rad` > 0 from side to side, its points' mean `mean_range_m` away. Angles
/// beyond 1.2 rad (a disc of 0.5 m at 0.9 m) are taken for that: so near, most things are not round.
[[nodiscard]] SeenDisc seen_disc(double mean_range_m, double angle_rad) noexcept;

/// The disc of `radius_m` that is seen from one side on, over `angle_rad` > 0; the mean's bearing is from that side.
[[nodiscard]] SeenDisc seen_side(double radius_m, double angle_rad, double mean_range_m,
                                 double mean_bearing_rad) noexcept;

/// The raw scans of the last second, of all scanners. A thing that walks stands where beams passed; one that only comes
/// into view, or shows another side, does not. Memory in the constructor. Thread: the loop's.
class PastScans {
 public:
  PastScans() : kept_(std::make_unique<std::array<Kept, kMost>>()) {}
  /// `scan`, taken by the laser at `robot_from_laser` of a robot that was at `map_from_robot` and moved with `twist`.
  /// Scans of one scanner that come sooner than kApart are left out.
  void keep(const LaserScan& scan, const Pose2& map_from_robot, const Pose2& robot_from_laser,
            const Twist2& twist) noexcept;
  /// Share, 0 to 1, of the looks at these places, in the map, that went through, of all that told anything, in scans
  /// taken kUntil to kSince before `now`; none where none told.
  [[nodiscard]] std::optional<double> seen_through(std::span<const Vec2> places, Time now) const noexcept;

 private:
  static constexpr std::size_t kMost = 16;
  struct Kept {
    LaserScan scan;
    Pose2 map_from_robot, robot_from_laser;
    Twist2 twist;
  };
  std::unique_ptr<std::array<Kept, kMost>> kept_;
  std::size_t count_ = 0;  ///< that were ever kept
};

}  // namespace jaywalk
