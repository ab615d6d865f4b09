#pragma once
// The first step of scan matching: which pose near the prediction puts most of the scan on walls.
#include <cstddef>

#include "hal/types/fixed_vector.h"
#include "planner/grid/evidence_map.h"
#include "planner/localization/symmetric3.h"

namespace jaywalk {

struct PoseBelief {
  Pose2 map_from_robot;
  Symmetric3 covariance;  ///< of (x, y, heading), in the map
};

/// The points that are matched, in the robot's frame: every n-th of the scan's.
inline constexpr std::size_t kMostMatchPoints = 240;
using MatchSample = FixedVector<Vec2, kMostMatchPoints>;

/// `by` in the map's directions, and turned.
[[nodiscard]] Pose2 moved(const Pose2& pose, const Row3& by) noexcept;
/// What to be moved by to get from one to the other; the turn in [-pi, pi).
[[nodiscard]] Row3 offset(const Pose2& from, const Pose2& to) noexcept;

/// The best pose of a lattice of cells and two degrees, then of one of half cells and one degree, three standard
/// deviations about the prediction (0.4 m and 24 degrees at most). `information`: the inverse of its covariance, by
/// which poses farther off must fit better. It is the valley to go down from, no more exact than half a cell.
[[nodiscard]] Pose2 search_about(const PoseBelief& predicted, const Symmetric3& information, const MatchSample& sample,
                                 const EvidenceMap& still) noexcept;

}  // namespace jaywalk
