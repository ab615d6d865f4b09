#pragma once
// Correlative scan matching (Olson 2009): which pose near the prediction puts most of the scan on walls.
#include <cstddef>

#include "hal/types/fixed_vector.h"
#include "planner/localization/pose_belief.h"
#include "planner/mapping/evidence_map.h"

namespace jaywalk {

/// The points that are matched, in the robot's frame: every n-th of the scan's.
inline constexpr std::size_t kMostMatchPoints = 240;
using MatchSample = FixedVector<Vec2, kMostMatchPoints>;

/// What a scan is matched to. The defaults are for the map of what stands, which knows free space, and whose errors
/// neighbouring points share: by trial, tables of docs/explanation/results.md#tracking-and-poses.
struct ScanReference {
  const EvidenceMap& map;
  double kernel_m = 0.08;           ///< residuals beyond count less and less (Geman and McClure's kernel)
  double independent_share = 0.06;  ///< of the points: whose errors are their own
  /// Of a point in unknown space to the search, in EvidenceMap::kMax: as much as on a wall that was hit once. Were it
  /// less, a robot that drives on would seem to stay where its walls are known.
  int unknown_worth = 48;
};

/// The best pose of a lattice of cells and two degrees, then of one of half cells and one degree, three standard
/// deviations about the prediction (0.4 m and 24 degrees at most). `information`: the inverse of its covariance, by
/// which poses farther off must fit better. It is the valley to go down from, no more exact than half a cell.
[[nodiscard]] Pose2 correlative_search(const PoseBelief& predicted, const Eigen::Matrix3d& information,
                                       const MatchSample& sample, const ScanReference& reference) noexcept;

}  // namespace jaywalk
