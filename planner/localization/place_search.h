#pragma once
// Search for a lost place: from which pose a scan was taken, within reach of another.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "hal/types/geometry.h"
#include "planner/localization/scan_matcher.h"

namespace jaywalk {
// Lattice of poses and rules of visibility that both searches of a place share: on a map before the start
// (global_search.h), and about a pose while the loop runs (PlaceSearch).

inline constexpr std::int32_t kLatticeCells = 2;                        ///< from a place to the next
inline constexpr int kLatticeHeadings = 90;                             ///< in a turn
inline constexpr std::int32_t kNearCells = 3;                           ///< half a step moves points 8 m off so far
inline constexpr double kPlacesApart_m = 1.0, kPlacesApart_rad = 0.52;  ///< nearer poses are one place
inline constexpr double kBeforePoint_m = 0.3;                           ///< a wall this much nearer hides a point

[[nodiscard]] inline bool are_places_apart(const Pose2& a, const Pose2& b) noexcept {
  return distance(a.position(), b.position()) > kPlacesApart_m ||
         std::fabs(wrap_angle(a.heading - b.heading)) > kPlacesApart_rad;
}

/// True where a wall hides `point` from the laser: a beam does not pass through one (Thrun, Burgard, Fox: Probabilistic
/// Robotics, 2005, 6.3). `is_wall(place)` is asked every `step_m`.
template <class IsWall>
[[nodiscard]] bool is_hidden(Vec2 laser, Vec2 point, double step_m, const IsWall& is_wall) {
  const double range = distance(laser, point);
  const Vec2 along = (point - laser) * (1.0 / std::max(range, step_m));
  for (double gone = step_m; gone < range - kBeforePoint_m; gone += step_m)
    if (is_wall(laser + along * gone)) return true;
  return false;
}

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
  [[nodiscard]] bool fits() const noexcept;
  /// The scan may have been taken there: most of it is known, and most of what is known fits.
  [[nodiscard]] bool is_good() const noexcept;
  /// The map knows too little of what the scan shows to say anything.
  [[nodiscard]] bool says_nothing() const noexcept;
  /// True where it explains the scan so much better than `other` that only one of the two can be right.
  [[nodiscard]] bool is_clearly_better_than(const PlaceFit& other) const noexcept;
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

}  // namespace jaywalk
