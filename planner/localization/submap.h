#pragma once
// The last few keyframes as a map of their own: what a scan is matched to where the map no longer explains scans.
#include <array>
#include <cstdint>
#include <vector>

#include "planner/localization/correlative_search.h"
#include "planner/mapping/evidence_map.h"

namespace jaywalk {

/// Scan-to-submap matching (Hess and others 2016, IV): a map that was drawn elsewhere on a long way is off by the drift
/// since, the last keyframes are not. Thread: the loop's. The constructor allocates, nothing else does.
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
