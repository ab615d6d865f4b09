#pragma once
// The still part of the world, ready to be asked: where does a ray end, how near is a wall.
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "hal/maps/wall_map.h"
#include "hal/types/robot_model.h"

namespace jaywalk::sim {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Box {
  Vec2 low, high;
};

/// Walls sorted into square buckets. Queries are exact (floating point), allocate nothing and never throw.
class Walls {
 public:
  explicit Walls(WallMap map);

  /// Distance (m) along the ray (unit `direction`) to the first wall, infinity when none is met within `max_range`.
  [[nodiscard]] double cast(Vec2 from, Vec2 direction, double max_range) const noexcept;
  /// Distance (m) to the nearest wall, at most `cap`; 0 inside a solid cell or a disc.
  [[nodiscard]] double distance(Vec2 p, double cap) const noexcept;
  /// Distance (m) from the robot's footprint to the nearest wall; 0 when touching, infinity without walls.
  [[nodiscard]] double clearance(const Footprint& footprint, const Pose2& map_from_robot) const noexcept;

  /// Calls `visit` with each WallSegment and Disc that may lie within `reach` of `p`; some may come twice.
  template <class Visit>
  void for_each_near(Vec2 p, double reach, Visit&& visit) const {
    const Span columns = overlap(p.x, reach, bounds_.low.x, columns_);
    const Span rows = overlap(p.y, reach, bounds_.low.y, rows_);
    for (std::int32_t row = rows.begin; row < rows.end; ++row)
      for (std::int32_t column = columns.begin; column < columns.end; ++column)
        visit_bucket(row * columns_ + column, visit);
  }

  [[nodiscard]] std::span<const WallSegment> segments() const noexcept { return map_.segments; }
  [[nodiscard]] std::span<const Disc> discs() const noexcept { return map_.discs; }
  /// A box round all walls.
  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }

 private:
  struct Span {
    std::int32_t begin, end;
  };
  [[nodiscard]] Span overlap(double centre, double reach, double low, std::int32_t count) const noexcept;
  [[nodiscard]] double nearest_to_footprint(const Footprint& footprint, const Pose2& map_from_robot,
                                            double reach) const noexcept;
  [[nodiscard]] bool solid_at(Vec2 p) const noexcept;
  void size_buckets();
  void fill_buckets();
  [[nodiscard]] Vec2 bucket_centre(std::int32_t bucket) const noexcept;

  template <class Visit>
  void visit_bucket(std::int32_t bucket, Visit& visit) const {
    const auto b = static_cast<std::size_t>(bucket);
    for (std::uint32_t k = first_[b]; k < first_[b + 1]; ++k) {
      const std::uint32_t item = items_[k];
      if (item < map_.segments.size())
        visit(map_.segments[item]);
      else
        visit(map_.discs[item - map_.segments.size()]);
    }
  }

  WallMap map_;
  Transform2 raster_from_map_;
  Box bounds_{};
  double bucket_m_ = 0.5;
  std::int32_t columns_ = 1, rows_ = 1;
  std::vector<std::uint32_t> first_;  ///< of each bucket's items in items_; one more at the end
  std::vector<std::uint32_t> items_;  ///< segments first, then discs
};

// Free places between walls, and zones that must be free.

/// Where a circle fits between the walls, in cells of 5 cm (larger in worlds over 200 m), and what of it can be
/// reached. The grid ends a metre beyond the walls and the two points given.
class FreeGrid {
 public:
  FreeGrid(const Walls& walls, double radius_m, Vec2 start, Vec2 goal);

  [[nodiscard]] bool free(Vec2 p) const noexcept;
  /// True where the circle can get from the start.
  [[nodiscard]] bool reachable(Vec2 p) const noexcept;
  /// Length (m) of the shortest way from start to goal, infinity when there is none: a shortest path over the eight
  /// neighbours, pulled straight. Within 1 % of the true one, tested. Allocates.
  [[nodiscard]] double shortest_path_m() const;

 private:
  static constexpr std::int32_t kOutside = -1;
  static constexpr std::uint8_t kFree = 1, kReached = 2;

  [[nodiscard]] std::int32_t index_of(Vec2 p) const noexcept;
  [[nodiscard]] Vec2 centre_of(std::int32_t index) const noexcept;
  [[nodiscard]] std::uint8_t state(std::int32_t index) const noexcept {
    return state_[static_cast<std::size_t>(index)];
  }
  template <class Visit>
  void for_each_neighbour(std::int32_t index, Visit&& visit) const;
  void flood_from_start();
  [[nodiscard]] std::vector<Vec2> cell_path() const;
  [[nodiscard]] bool line_is_free(Vec2 from, Vec2 to) const;
  [[nodiscard]] std::vector<Vec2> pulled(const std::vector<Vec2>& path) const;

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
  [[nodiscard]] double gap(const Disc& disc) const noexcept;
  [[nodiscard]] bool in(const Zone& zone) const noexcept;
};

}  // namespace jaywalk::sim
