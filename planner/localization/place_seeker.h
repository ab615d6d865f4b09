#pragma once
#include <optional>

#include "planner/localization/place_search.h"

namespace jaywalk {

/// Looks for a robot in doubt on the map, again and again while it stands: a search for a scan of each scanner, then a
/// newer scan that confirms the one place that was found. Thread: the loop's.
class PlaceSeeker {
 public:
  explicit PlaceSeeker(std::size_t scanners) noexcept : scanners_(scanners) {}

  void begin_anew() noexcept;
  /// A scan in doubt: its points and its laser in the robot's frame, and the robot's pose by its wheels at its stamp.
  /// The robot's pose in the map then, once it is found and confirmed.
  [[nodiscard]] std::optional<Pose2> take(const ScanPoints& points, Vec2 laser_in_robot, std::size_t scanner,
                                          const Pose2& odom_from_robot, const EvidenceMap& still) noexcept;
  /// Once a tick: a part of the search. `about`: where the robot was known last.
  void step(const EvidenceMap& still, Vec2 about) noexcept;

 private:
  [[nodiscard]] std::optional<Pose2> confirmed(const ScanPoints& points, Vec2 laser_in_robot,
                                               const EvidenceMap& still) noexcept;

  std::size_t scanners_;
  PlaceSearch search_;
  SeenSample sample_;
  unsigned gave_ = 0;   ///< scanners that are in it, a bit each
  bool found_ = false;  ///< one place, which a scan is to confirm
  Pose2 odom_from_robot_;
};

}  // namespace jaywalk
