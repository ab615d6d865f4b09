#pragma once
// The still part of the world, ready to be asked: where does a ray end, how near is a wall.
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "hal/maps/wall_map.h"
#include "hal/types/robot_model.h"

namespace jaywalk::sim {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

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
  [[nodiscard]] const Box2& bounds() const noexcept { return bounds_; }

 private:
  struct Span {
    std::int32_t begin, end;
  };
  [[nodiscard]] Span overlap(double centre, double reach, double low, std::int32_t count) const noexcept;
  [[nodiscard]] bool solid_at(Vec2 p) const noexcept;
  void size_buckets();
  void fill_buckets();
  [[nodiscard]] Vec2 bucket_centre(std::int32_t bucket) const noexcept {
    return bounds_.low + Vec2{bucket % columns_ + 0.5, bucket / columns_ + 0.5} * bucket_m_;
  }

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
  Box2 bounds_;
  double bucket_m_ = 0.5;
  std::int32_t columns_ = 1, rows_ = 1;
  std::vector<std::uint32_t> first_;  ///< of each bucket's items in items_; one more at the end
  std::vector<std::uint32_t> items_;  ///< segments first, then discs
};

}  // namespace jaywalk::sim
