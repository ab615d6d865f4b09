#pragma once
// Correlative scan matching (Olson 2009): the pose near the prediction that puts most of the scan on walls.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

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

/// The last keyframes as a map of their own, for scan-to-submap matching (Hess and others 2016, IV): a map that was
/// drawn elsewhere on a long way is off by the drift since, the last keyframes are not. Thread: the loop's. The
/// constructor allocates, nothing else does.
class Submap {
 public:
  Submap();

  /// Keeps the scan as a keyframe if the robot has gone 0.4 m or turned 0.3 rad since the last; the oldest of eight
  /// goes.
  void add(const MatchSample& in_robot, const Pose2& map_from_robot) noexcept;
  /// The keyframes' points about `centre`, within 25 m: in each cell their mean. Nothing is known to be free.
  [[nodiscard]] const EvidenceMap& about(Vec2 centre_in_map) noexcept;
  /// Earlier poses are of another frame than later ones: the pose was moved by something else than scans and wheels.
  void begin_anew() noexcept { count_ = 0; }

 private:
  static constexpr std::size_t kKeyframes = 8;
  struct Keyframe {
    Pose2 map_from_robot;
    MatchSample in_robot;
  };
  /// The points that fell into one cell.
  struct CellSum {
    CellIndex cell;
    int count = 0;
    Vec2 from_centre{}, to_laser{};
  };
  void add_up(const Keyframe& keyframe) noexcept;
  [[nodiscard]] CellSum* sum_of(CellIndex cell) noexcept;

  std::array<Keyframe, kKeyframes> keyframes_;
  std::size_t count_ = 0;  ///< ever kept
  EvidenceMap map_;
  FixedVector<CellSum, kKeyframes * kMostMatchPoints> sums_;
  std::vector<std::uint16_t> sum_at_;  ///< of a slot of the map: its place in sums_, and one; 0: none
};

}  // namespace jaywalk
