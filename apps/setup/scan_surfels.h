#pragma once
// Scans as pieces of surfaces, and how one lies on another: for commissioning and calibration. Start-up only;
// allocates.
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"

namespace jaywalk {

/// Fewer than these are no scan to be matched.
inline constexpr std::size_t kLeastSurfels = 40;
/// Of the points' normals, the mean square across the direction that is seen least: two points in a hundred on a wall
/// across.
inline constexpr double kLeastAcross = 0.02;

/// A point of a surface and the surface's normal there, m, in the laser's frame.
struct Surfel {
  Vec2 at, normal;
};

/// Where each beam ends, in the laser's frame at the scan's stamp; nothing for one that hit nothing.
using BeamEnds = std::vector<std::optional<Vec2>>;

/// As of a laser that stood.
[[nodiscard]] BeamEnds beam_ends(const LaserScan& scan);
/// 400 at most; `step_rad` is from a beam to the next.
[[nodiscard]] std::vector<Surfel> surfels_of(const BeamEnds& ends, double step_rad);

/// How far off what does not lie on anything counts (m).
inline constexpr double kFarOff_m = 0.2;

struct SurfelFit {
  Pose2 before_from_after;
  double left_m = kFarOff_m;  ///< mean distance to the other's surfaces, each at most kFarOff_m
  double across = 0.0;        ///< of the normals, the mean square in the direction that has least
  /// Sum over matched points of the outer products of (normal, turn's lever): of a pose in `before`'s frame, m and rad,
  /// in points; divided by the variance of a point it is the information.
  Eigen::Matrix3d points;
  double used = 0.0;  ///< points that were matched
};

/// Point to line (Chen and Medioni 1992) from `guess` on. `rest_points` points say that nothing moved. Where too little
/// lies on the other, `used` is 0.
[[nodiscard]] SurfelFit fit_surfels(const Pose2& guess, const std::vector<Surfel>& before,
                                    const std::vector<Surfel>& after, double rest_points);

/// How a laser moved between two scans of the same room, before_from_after: fit_surfels() from turns of up to 70
/// degrees either way, the best of them. The turn is exact; a way that few points tell is taken to be short. Nothing
/// where they have too little in common. Takes about a second.
[[nodiscard]] std::optional<Pose2> match_scans(const LaserScan& before, const LaserScan& after);

/// How badly the scans fit one another at that pose: the mean distance across the surfaces, each at most 0.1 m.
[[nodiscard]] double misfit_m(const LaserScan& before, const LaserScan& after, const Pose2& before_from_after);

}  // namespace jaywalk
