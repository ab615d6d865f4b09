#pragma once
// What a map file says: where the walls are. Three kinds of file give the same thing.
#include <cstdint>
#include <filesystem>
#include <vector>

#include "hal/types/geometry.h"

namespace jaywalk::sim {

/// One straight piece of wall, in the map.
struct WallSegment {
  Vec2 from, to;
};

/// A round pillar, or the body of a mover, in the map.
struct Disc {
  Vec2 centre;
  double radius_m = 0.0;
};

[[nodiscard]] inline double distance(Vec2 p, const WallSegment& segment) noexcept {
  return distance(p, nearest_on_segment(p, segment.from, segment.to));
}

/// Distance (m) along the ray (unit `direction`) to the shape; infinity when it misses, 0 from inside a disc.
[[nodiscard]] double hit_range(Vec2 from, Vec2 direction, const WallSegment& segment) noexcept;
[[nodiscard]] double hit_range(Vec2 from, Vec2 direction, const Disc& disc) noexcept;

enum class MapKind { kYaml, kAria, kCylinders };

/// Square cells, some of them solid. Row 0 is the lowest, column 0 the leftmost in the raster's frame.
struct Raster {
  Pose2 map_from_raster;
  double cell_m = 0.0;
  std::int32_t width = 0;
  std::int32_t height = 0;
  std::vector<std::uint8_t> solid;   ///< width x height, row by row; 1: wall
  std::vector<std::uint8_t> free{};  ///< the same; 1: known to be none, below free_thresh. May be empty: of none

  /// False outside the raster.
  [[nodiscard]] bool solid_cell(std::int32_t column, std::int32_t row) const noexcept {
    if (column < 0 || row < 0 || column >= width || row >= height) return false;
    return solid[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
  }
  /// Of a cell inside.
  [[nodiscard]] bool free_cell(std::int32_t column, std::int32_t row) const noexcept {
    const std::size_t cell =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
    return cell < free.size() && free[cell] != 0;
  }
};

struct WallMap {
  std::vector<WallSegment> segments;
  std::vector<Disc> discs;
  Raster raster;  ///< empty unless the file is a picture; its segments are the edges of its solid cells
};

/// Throws StartupError "FILE:LINE: cause; remedy" for a file that cannot be read or makes no sense.
[[nodiscard]] WallMap load_wall_map(MapKind kind, const std::filesystem::path& file);

/// The file itself and, of a raster map, its picture. Throws as load_wall_map() does.
[[nodiscard]] std::vector<std::filesystem::path> files_of_map(MapKind kind, const std::filesystem::path& file);

/// 500 m in cells of 5 cm: a raster takes two bytes a cell.
inline constexpr std::int32_t kMostRasterCells = 10'000;
/// ROS map_server's YAML: a cell is a wall when its occupancy exceeds occupied_thresh; unknown ones are none. What
/// has more cells a side than `most_cells` is read in larger ones (read_raster).
[[nodiscard]] Raster load_raster(const std::filesystem::path& yaml_file, std::int32_t most_cells = kMostRasterCells);
/// MobileSim's text map in millimetres: its LINES are walls; when it has none, its DATA points are, as discs.
[[nodiscard]] WallMap load_aria_map(const std::filesystem::path& file);
/// One cylinder a line: x y radius (m); # starts a comment.
[[nodiscard]] WallMap load_cylinder_map(const std::filesystem::path& file);

/// The straight edges between solid and open cells, each as long as it can be.
[[nodiscard]] std::vector<WallSegment> edges_of(const Raster& raster);

}  // namespace jaywalk::sim
