#pragma once
// Searches for the pose from which a scan was taken: within reach of another while the loop runs, or on a whole map.
#include <cstdint>
#include <vector>

#include "hal/types/geometry.h"
#include "planner/localization/scan_matcher.h"
#include "planner/mapping/known_map.h"

namespace jaywalk {
/// A sample of a scan's points, and from where the laser saw each; both in the robot's frame.
struct SeenSample {
  MatchSample points;
  FixedVector<Vec2, kMostMatchPoints> lasers;
};
/// Adds one of `scanners` scanners' points: every n-th, so that all of them find room.
void add_sample(const ScanPoints& scan, Vec2 laser_in_robot, std::size_t scanners, SeenSample& to) noexcept;

/// Fit of a sample to the map from a pose.
struct PlaceFit {
  Pose2 map_from_robot;
  double on_walls = 0.0;  ///< share of the points: walls are there, and none before them
  double known = 0.0;     ///< share of the points of which the map knows what is there
  [[nodiscard]] double fit() const noexcept { return known > 0.0 ? on_walls / known : 0.0; }
  /// Most of what the map knows of it fits.
  [[nodiscard]] bool fits() const noexcept { return fit() >= kFits; }
  /// The scan may have been taken there: most of it is known, and most of what is known fits.
  [[nodiscard]] bool is_good() const noexcept { return known >= kKnown && fits(); }
  /// The map knows too little of what the scan shows to say anything.
  [[nodiscard]] bool says_nothing() const noexcept { return known < kSaysNothing; }
  /// True where it explains the scan so much better than `other` that only one of the two can be right: the map
  /// contradicts a smaller share of the points, by kClearly. Places that it knows little of contradict nothing.
  [[nodiscard]] bool is_clearly_better_than(const PlaceFit& other) const noexcept {
    return on_walls > other.on_walls && known - on_walls + kClearly < other.known - other.on_walls;
  }

  /// Shares of the points known, and of these on walls; people stand before the others (robot_tests "[carried]").
  static constexpr double kKnown = 0.5, kFits = 0.7, kSaysNothing = 0.3, kClearly = 0.1;
};

/// Search for the place, within 12.8 m of another, from which a scan was taken.
///
/// Correlative search over the cells that were seen free, all headings, in steps of two cells and four degrees; the
/// best that lie apart are matched closely (match_sample) and judged by what the laser could see from there
/// (is_hidden). One part of it a call, a millisecond or two: for the tick. Thread: the loop's. The constructor
/// allocates 2 MB.
class PlaceSearch {
 public:
  PlaceSearch();
  /// Begins anew for a scan taken near `about`.
  void begin(const SeenSample& sample, Vec2 about) noexcept;
  void give_up() noexcept { stage_ = Stage::kIdle; }
  [[nodiscard]] bool is_busy() const noexcept { return stage_ != Stage::kIdle; }
  /// The next part, on the same map as the part before. True when that was the last.
  bool step(const EvidenceMap& map) noexcept;
  /// The best place after the last part; no points on walls: there is none.
  [[nodiscard]] const PlaceFit& best() const noexcept { return best_; }

  /// The best match about a pose known to these standard deviations, and how well it fits.
  [[nodiscard]] static PlaceFit matched(const SeenSample& sample, const EvidenceMap& map, const Pose2& about,
                                        double position_std_m, double heading_std_rad) noexcept;

 private:
  enum class Stage : std::uint8_t { kIdle, kDraw, kLook, kMatch };
  static constexpr std::int32_t kSide = 1024;  ///< cells, of what is drawn
  static constexpr std::size_t kMostCandidates = 48;
  struct Candidate {
    Pose2 pose;
    int worth = 0;
  };
  void draw(const EvidenceMap& map) noexcept;
  void draw_wall(std::int32_t i, std::int32_t j) noexcept;
  void look(const EvidenceMap& map) noexcept;
  void note(const Candidate& seen) noexcept;
  [[nodiscard]] bool match(const EvidenceMap& map) noexcept;

  Stage stage_ = Stage::kIdle;
  SeenSample sample_;
  Vec2 about_;
  CellIndex low_;
  std::int32_t row_ = 0;                 ///< next to be drawn
  int heading_ = 0;                      ///< next to be looked at
  std::size_t candidate_ = 0;            ///< next to be matched
  std::vector<std::uint8_t> near_wall_;  ///< kSide rows; 1: a wall is as near as a coarse step
  std::vector<std::uint32_t> free_;      ///< cells of the lattice that were seen free: index into near_wall_
  FixedVector<Candidate, kMostCandidates> candidates_;
  PlaceFit best_;
};

/// Where on a map a scan was taken, and how surely.
struct GlobalMatch {
  Pose2 map_from_robot;
  double share = 0.0;          ///< of the points that lie on walls there with no wall before them, 0 to 1
  std::optional<Pose2> other;  ///< the best pose more than a metre or 30 degrees off
  double other_share = 0.0;
};

/// Correlative search over all free cells and headings: which pose puts most of the scan on walls. In steps of 0.2 m
/// and 4 degrees, then about the best in steps of 5 cm and 1 degree. Of these the pose counts at which most points are
/// walls that the laser, `laser_in_robot`, can see: a beam does not pass through a wall (Thrun, Burgard, Fox:
/// Probabilistic Robotics, 2005, 6.3). Seconds for a hall of 50 m: for start-up, it allocates.
[[nodiscard]] GlobalMatch search_everywhere(const KnownMap& map, const MatchSample& sample, Vec2 laser_in_robot);

}  // namespace jaywalk
