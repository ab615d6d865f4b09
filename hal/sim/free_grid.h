#pragma once
// Free places between walls, and zones that must be free.
#include <array>
#include <cstdint>
#include <vector>

#include "hal/maps/wall_map.h"
#include "hal/sim/walls.h"
#include "hal/types/robot_model.h"

namespace jaywalk::sim {

/// Where a circle fits between the walls, in cells of 5 cm (larger in worlds over 200 m), and what of it can be
/// reached. The grid ends a metre beyond the walls and the two points given.
class FreeGrid {
 public:
  FreeGrid(const Walls& walls, double radius_m, Vec2 start, Vec2 goal);

  [[nodiscard]] bool free(Vec2 p) const noexcept {
    const std::int32_t index = index_of(p);
    return index != kOutside && state(index) != 0;
  }
  /// True where the circle can get from the start.
  [[nodiscard]] bool reachable(Vec2 p) const noexcept {
    const std::int32_t index = index_of(p);
    return index != kOutside && (state(index) & kReached) != 0;
  }
  /// True where the circle can go straight.
  [[nodiscard]] bool line_is_free(Vec2 from, Vec2 to) const noexcept {
    const auto samples = static_cast<int>(distance(from, to) / (0.5 * cell_m_)) + 1;
    for (int k = 0; k <= samples; ++k)
      if (!free(from + (to - from) * (static_cast<double>(k) / samples))) return false;
    return true;
  }
  /// Length (m) of the shortest way from start to goal, infinity when there is none: a shortest path over the eight
  /// neighbours, pulled straight. Within 1 % of the true one, tested. Allocates.
  [[nodiscard]] double shortest_path_m() const;

 private:
  static constexpr std::int32_t kOutside = -1;
  static constexpr std::uint8_t kFree = 1, kReached = 2;

  [[nodiscard]] std::int32_t index_of(Vec2 p) const noexcept {
    const double column = std::floor((p.x - low_.x) / cell_m_), row = std::floor((p.y - low_.y) / cell_m_);
    if (!(column >= 0.0 && row >= 0.0 && column < columns_ && row < rows_)) return kOutside;
    return static_cast<std::int32_t>(row) * columns_ + static_cast<std::int32_t>(column);
  }
  [[nodiscard]] Vec2 centre_of(std::int32_t index) const noexcept {
    return low_ + Vec2{index % columns_ + 0.5, index / columns_ + 0.5} * cell_m_;
  }
  [[nodiscard]] std::uint8_t state(std::int32_t index) const noexcept {
    return state_[static_cast<std::size_t>(index)];
  }
  template <class Visit>
  void for_each_neighbour(std::int32_t index, Visit&& visit) const;
  void flood_from_start();
  [[nodiscard]] std::vector<Vec2> cell_path() const;
  /// From each point goes straight to the last one that can be seen, then from there.
  [[nodiscard]] std::vector<Vec2> pulled(const std::vector<Vec2>& path) const {
    std::vector<Vec2> taut{path.front()};
    for (std::size_t k = 1; k + 1 < path.size(); ++k)
      if (!line_is_free(taut.back(), path[k + 1])) taut.push_back(path[k]);
    taut.push_back(path.back());
    return taut;
  }

  Vec2 start_, goal_;
  Vec2 low_;
  double cell_m_ = 0.05;
  std::int32_t columns_ = 0, rows_ = 0;
  std::vector<std::uint8_t> state_;
};

/// How far ahead of its edge a mover looks, wandering and recorded.
inline constexpr double kWanderZone = 0.5;
inline constexpr double kRecordedZone = 0.4;

/// What a mover heeds ahead of it: the points within `reach_m` of `apex` and within +-45 degrees of `ahead`.
struct Zone {
  Vec2 apex;
  Vec2 ahead;  ///< unit vector
  double reach_m = 0.0;

  [[nodiscard]] bool meets(const WallSegment& segment) const noexcept;
  [[nodiscard]] bool meets(const Disc& disc) const noexcept;
};

/// The robot as an obstacle: its footprint where it stands.
struct RobotBody {
  Footprint footprint;
  Pose2 map_from_robot;

  [[nodiscard]] std::array<WallSegment, 4> edges() const noexcept;
  /// Gap (m) between the footprint and a disc; 0 when they touch.
  [[nodiscard]] double gap(const Disc& disc) const noexcept {
    return std::max(footprint.distance_to(inverse(map_from_robot) * disc.centre) - disc.radius_m, 0.0);
  }
  [[nodiscard]] bool in(const Zone& zone) const noexcept {
    const double far = zone.reach_m + footprint.circumscribed_radius_m();
    const Vec2 offset = map_from_robot.position() - zone.apex;
    if (dot(offset, offset) > far * far) return false;
    const auto sides = edges();
    return std::any_of(sides.begin(), sides.end(), [&](const WallSegment& side) { return zone.meets(side); });
  }
  /// True where a mover at `next` touches the robot and came nearer to its middle: two that touch can part.
  [[nodiscard]] bool is_run_into(Vec2 before, const Disc& next) const noexcept {
    const Vec2 middle = map_from_robot.position();
    return gap(next) <= 0.0 && distance(next.centre, middle) < distance(before, middle);
  }
};

}  // namespace jaywalk::sim
