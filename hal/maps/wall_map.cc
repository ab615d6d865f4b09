#include "hal/maps/wall_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include "hal/shown_text.h"
#include "hal/text_file.h"
#include "hal/types/errors.h"

namespace jaywalk::sim {
namespace {

constexpr double kMiss = std::numeric_limits<double>::infinity();
constexpr double kEndSlack = 1e-9;  // share of a segment's length: no ray slips between two that share a corner

constexpr double kMetresPerMillimetre = 0.001;
constexpr double kDataPointRadius = 0.02;  // m: a laser reading stands for a small piece of wall
constexpr double kFarthest = 1e6;          // m

/// Exactly `count` lengths, and nothing else, from the line that was read last.
std::vector<double> lengths_in(const std::string& line, std::size_t count, const LineReader& reader) {
  const std::vector<double> values = LineReader::numbers(line, count);
  const bool sound = std::all_of(values.begin(), values.end(),
                                 [](double v) { return std::fabs(v) <= kFarthest / kMetresPerMillimetre; });
  if (values.empty() || !sound) reader.refuse("\"" + shown(line) + "\" is not " + std::to_string(count) + " numbers");
  return values;
}

/// The number behind `name`, where the line has that.
void read_count(const std::string& line, const std::string& name, std::size_t& count) {
  if (line.rfind(name, 0) == 0) std::istringstream(line.substr(name.size())) >> count;
}

bool is_blank(const std::string& line) { return line.find_first_not_of(" \t") == std::string::npos; }

}  // namespace

WallMap load_wall_map(MapKind kind, const std::filesystem::path& file) {
  if (kind == MapKind::kAria) return load_aria_map(file);
  if (kind == MapKind::kCylinders) return load_cylinder_map(file);
  WallMap map;
  map.raster = load_raster(file);
  map.segments = edges_of(map.raster);
  return map;
}

double distance(Vec2 p, const WallSegment& segment) noexcept {
  return distance(p, nearest_on_segment(p, segment.from, segment.to));
}

double hit_range(Vec2 from, Vec2 direction, const WallSegment& segment) noexcept {
  // from + range d = segment.from + share e, solved by crossing both sides with e and with d.
  const Vec2 e = segment.to - segment.from;
  const Vec2 to_wall = segment.from - from;
  const double slant = cross(direction, e);
  if (slant == 0.0) return kMiss;  // parallel: a wall seen edge-on
  const double range = cross(to_wall, e) / slant;
  const double share = cross(to_wall, direction) / slant;
  return range >= 0.0 && share >= -kEndSlack && share <= 1.0 + kEndSlack ? range : kMiss;
}

double hit_range(Vec2 from, Vec2 direction, const Disc& disc) noexcept {
  const Vec2 to_centre = disc.centre - from;
  const double radius2 = disc.radius_m * disc.radius_m;
  if (dot(to_centre, to_centre) <= radius2) return 0.0;
  const double ahead = dot(to_centre, direction);
  const double aside = cross(to_centre, direction);
  const double half_chord2 = radius2 - aside * aside;
  return ahead > 0.0 && half_chord2 >= 0.0 ? ahead - std::sqrt(half_chord2) : kMiss;
}

WallMap load_aria_map(const std::filesystem::path& file) {
  enum class Section { kHeader, kLines, kData };
  std::size_t lines_told = 0, points_told = 0;
  LineReader reader(file, "give a map as MobileSim writes it");
  std::string line;
  if (!reader.next(line) || line.rfind("2D-Map", 0) != 0) reader.refuse("does not begin with 2D-Map");
  WallMap map;
  std::vector<Disc> points;
  Section section = Section::kHeader;
  while (reader.next(line)) {
    if (is_blank(line)) continue;
    if (line == "LINES" || line == "DATA") {
      section = line == "LINES" ? Section::kLines : Section::kData;
    } else if (section == Section::kLines) {
      const auto v = lengths_in(line, 4, reader);
      map.segments.push_back({Vec2{v[0], v[1]} * kMetresPerMillimetre, Vec2{v[2], v[3]} * kMetresPerMillimetre});
    } else if (section == Section::kData) {
      const auto v = lengths_in(line, 2, reader);
      points.push_back({Vec2{v[0], v[1]} * kMetresPerMillimetre, kDataPointRadius});
    } else {
      read_count(line, "NumLines:", lines_told);
      read_count(line, "NumPoints:", points_told);
    }
  }
  if (map.segments.size() < lines_told) reader.refuse("ends before its NumLines: it was cut");
  if (points.size() < points_told) reader.refuse("ends before its NumPoints: it was cut");
  if (map.segments.empty()) map.discs = std::move(points);
  if (map.segments.empty() && map.discs.empty()) reader.refuse("has neither LINES nor DATA");
  return map;
}

WallMap load_cylinder_map(const std::filesystem::path& file) {
  LineReader reader(file, "write x y radius in metres, one cylinder a line");
  WallMap map;
  for (std::string line; reader.next(line);) {
    line.erase(std::min(line.find('#'), line.size()));
    if (is_blank(line)) continue;
    const auto v = lengths_in(line, 3, reader);
    if (!(v[2] > 0.0)) reader.refuse("a cylinder needs a radius above 0");
    map.discs.push_back({{v[0], v[1]}, v[2]});
  }
  if (map.discs.empty()) reader.refuse("holds no cylinder");
  return map;
}

}  // namespace jaywalk::sim
