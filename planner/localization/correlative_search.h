#pragma once
// Correlative scan matching (Olson 2009): which pose near the prediction puts most of the scan on walls.
#include <cstddef>

#include "hal/types/fixed_vector.h"
#include "planner/grid/evidence_map.h"
#include "planner/localization/pose_belief.h"

namespace jaywalk {

/// The points that are matched, in the robot's frame: every n-th of the scan's.
inline constexpr std::size_t kMostMatchPoints = 240;
using MatchSample = FixedVector<Vec2, kMostMatchPoints>;

/// The best pose of a lattice of cells and two degrees, then of one of half cells and one degree, three standard
/// deviations about the prediction (0.4 m and 24 degrees at most). `information`: the inverse of its covariance, by
/// which poses farther off must fit better. It is the valley to go down from, no more exact than half a cell.
[[nodiscard]] Pose2 correlative_search(const PoseBelief& predicted, const Eigen::Matrix3d& information,
                                       const MatchSample& sample, const EvidenceMap& still) noexcept;

}  // namespace jaywalk
