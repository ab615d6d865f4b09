#include "firmware/recording/map_files.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "hal/maps/wall_map.h"
#include "hal/shown_text.h"
#include "hal/text_file.h"
#include "hal/types/errors.h"
#include "planner/localization/place_search.h"
#include "planner/localization/scan_matcher.h"
#include "planner/scan/scan_points.h"

namespace jaywalk {
namespace {

// What map_saver of ROS writes in its mode "trinary".
constexpr char kOccupied = 0;
constexpr auto kFree = static_cast<char>(254), kUnknown = static_cast<char>(205);
constexpr const char* kThresholds = "mode: trinary\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
constexpr const char* kAnotherFolder = "choose another --out folder";

/// Both ends belong to it.
struct CellBox {
  CellIndex low, high;
};

char shade_of(const EvidenceMap& map, CellIndex cell) {
  if (map.occupied(cell)) return kOccupied;
  return map.seen_free(cell) ? kFree : kUnknown;
}

/// The box of all cells that are known; the window's lowest cell where none is.
CellBox known_cells(const EvidenceMap& map) {
  const CellIndex first = map.low(), last{first.i + map.side() - 1, first.j + map.side() - 1};
  CellBox box{last, first};
  for (std::int32_t j = first.j; j <= last.j; ++j) {
    for (std::int32_t i = first.i; i <= last.i; ++i) {
      if (shade_of(map, {i, j}) == kUnknown) continue;
      box.low = {std::min(box.low.i, i), std::min(box.low.j, j)};
      box.high = {std::max(box.high.i, i), std::max(box.high.j, j)};
    }
  }
  return box.high.i < box.low.i ? CellBox{first, first} : box;
}

std::string pgm_of(const EvidenceMap& map, const CellBox& box) {
  std::string bytes = "P5\n" + std::to_string(box.high.i - box.low.i + 1) + " " +
                      std::to_string(box.high.j - box.low.j + 1) + "\n255\n";
  for (std::int32_t j = box.high.j; j >= box.low.j; --j)
    for (std::int32_t i = box.low.i; i <= box.high.i; ++i) bytes += shade_of(map, {i, j});
  return bytes;
}

constexpr double kLeastShare =
    0.9;  ///< of a scan's points, seen walls: true places have 0.91 or more (robot_tests "[places]")
constexpr double kNearlyAsWell = 0.97;  ///< of the best place's share
constexpr std::size_t kFewestPoints = 30;

Box2 box_of(const sim::Raster& raster) {
  Box2 box;
  const double width = raster.width * raster.cell_m, height = raster.height * raster.cell_m;
  for (const Vec2 corner : {Vec2{0.0, 0.0}, Vec2{width, 0.0}, Vec2{0.0, height}, Vec2{width, height}})
    box.hold(raster.map_from_raster * corner);
  return box;
}

std::int32_t cell_of(double metres, double cell_m) { return static_cast<std::int32_t>(std::floor(metres / cell_m)); }
/// The first that has nothing before `metres` in it: a map that ends at a cell's border needs no cell beyond.
std::int32_t end_cell_of(double metres, double cell_m) {
  return static_cast<std::int32_t>(std::ceil(metres / cell_m - 1e-6));
}

/// Marks the cells of the map under each part of a raster's cell: parts no larger than half a cell of the map.
void draw(const sim::Raster& raster, KnownMap& map) {
  const int parts = std::max(1, static_cast<int>(std::ceil(2.0 * raster.cell_m / map.cell_m)));
  const Transform2 map_from_raster(raster.map_from_raster);
  std::vector<Vec2> part_of(
      static_cast<std::size_t>(parts * parts));  // from a cell's corner, turned, in the map's cells
  for (int k = 0; k < parts * parts; ++k)
    part_of[static_cast<std::size_t>(k)] =
        map_from_raster.rotate(Vec2{(k % parts + 0.5) / parts, (k / parts + 0.5) / parts} * raster.cell_m) *
        (1.0 / map.cell_m);
  for (std::int32_t row = 0; row < raster.height; ++row) {
    for (std::int32_t column = 0; column < raster.width; ++column) {
      const bool wall = raster.solid_cell(column, row);
      if (!wall && !raster.free_cell(column, row)) continue;
      const Vec2 corner = map_from_raster * (Vec2{column * 1.0, row * 1.0} * raster.cell_m) * (1.0 / map.cell_m);
      for (const Vec2& part : part_of) {
        const CellIndex at{cell_of(corner.x + part.x, 1.0), cell_of(corner.y + part.y, 1.0)};
        if (map.holds(at)) map.mark(at, wall ? KnownCell::kWall : KnownCell::kFree);
      }
    }
  }
}

std::string text_of(const Pose2& pose) { return formatted("[%.1f, %.1f, %.2f]", pose.x, pose.y, pose.heading); }

}  // namespace

void save_map(const EvidenceMap& map, const std::filesystem::path& folder) {
  const CellBox box = known_cells(map);
  write_text(folder / "map.pgm", pgm_of(map, box), kAnotherFolder);
  char place[160];  // of the lower left pixel's lower left corner, in the map
  std::snprintf(place, sizeof place, "image: map.pgm\nresolution: %.6g\norigin: [%.6f, %.6f, 0.0]\n", map.cell_m(),
                box.low.i * map.cell_m(), box.low.j * map.cell_m());
  write_text(folder / "map.yaml", std::string(place) + kThresholds, kAnotherFolder);
}

std::shared_ptr<const KnownMap> load_known_map(const std::filesystem::path& yaml, double cell_m) {
  const sim::Raster raster = sim::load_raster(yaml);
  const Box2 box = box_of(raster);
  auto map = std::make_shared<KnownMap>();
  map->cell_m = cell_m;
  map->low = {cell_of(box.low.x, cell_m), cell_of(box.low.y, cell_m)};
  map->width = end_cell_of(box.high.x, cell_m) - map->low.i;
  map->height = end_cell_of(box.high.y, cell_m) - map->low.j;
  if (map->width > kMostKnownCells || map->height > kMostKnownCells)
    throw StartupError(yaml.string() + formatted(": more than %.0f m a side", kMostKnownCells * cell_m),
                       "cut the map to where the robot drives");
  map->cells.assign(static_cast<std::size_t>(map->width) * static_cast<std::size_t>(map->height), KnownCell::kUnknown);
  draw(raster, *map);
  return map;
}

Pose2 located_on(const KnownMap& map, const LaserScan& scan, const LaserModel& laser, const std::string& place) {
  ScanProjection projection;
  ScanPoints points;
  projection.project(scan, laser.robot_from_laser, {}, points);
  const MatchSample sample = sample_of(points);
  const std::string remedy = "give start = [x, y, heading]";
  if (sample.size() < kFewestPoints)
    throw StartupError(place + "the scan has too few points to find its place", remedy);
  const GlobalMatch match = search_everywhere(map, sample, laser.robot_from_laser.position());
  const std::string share = formatted("%.0f %% of the scan", 100.0 * match.share);
  if (match.share < kLeastShare)
    throw StartupError(place + "the scan fits nowhere on the map: " + share + " at most", remedy);
  if (match.other && match.other_share > kNearlyAsWell * match.share)
    throw StartupError(
        place + "the scan fits at " + text_of(match.map_from_robot) + " and nearly as well at " + text_of(*match.other),
        remedy);
  return match.map_from_robot;
}

}  // namespace jaywalk
