#include "hal/maps/wall_map.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <sstream>
#include <string>

#include "hal/maps/image_file.h"
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

struct CellState {
  bool wall = false, free = false;
};

CellState state_of(const Pixel& pixel, const OccupancyRule& rule) {
  constexpr double kWhite = 65535.0;
  const double shade = (rule.mode == MapMode::kTrinary ? pixel.with_alpha : pixel.colour) / kWhite;
  double occupancy = rule.negate ? shade : 1.0 - shade;
  if (rule.mode == MapMode::kScale && !pixel.opaque) return {};
  if (rule.mode == MapMode::kRaw) occupancy = std::round(shade * 255.0) / 100.0;
  if (rule.mode == MapMode::kRaw && occupancy > 1.0) return {};
  return {occupancy > rule.occupied_above, occupancy < rule.free_below};
}

struct RasterSettings {
  std::filesystem::path image;
  double cell_m = 0.0;
  Pose2 origin;  ///< the picture's lower left corner in the map
  OccupancyRule rule;
};

/// The YAML file's keys, each refused with its line when it is wrong.
class MapYaml {
 public:
  explicit MapYaml(const std::filesystem::path& file) : file_(file) {
    refuse_picture();
    try {
      root_ = YAML::LoadFile(file.string());
    } catch (const YAML::BadFile&) {
      throw StartupError(file_.string() + ": cannot be read", "give the path of a map_server YAML file");
    } catch (const YAML::Exception& e) {
      refuse(e.mark, e.msg);
    }
    if (!root_.IsMap()) refuse(root_.Mark(), "holds no keys");
    refuse_repeated_keys();
  }

  template <class T>
  [[nodiscard]] T get(const std::string& key, const std::optional<T>& otherwise = {}) const {
    const YAML::Node node = root_[key];
    if (!node && otherwise) return *otherwise;
    if (!node) refuse(root_.Mark(), key + " is missing");
    try {
      return node.as<T>();
    } catch (const YAML::Exception&) {
      refuse(node.Mark(), key + " has the wrong type");
    }
  }
  [[nodiscard]] double share(const std::string& key, double otherwise) const {
    const double value = get<double>(key, otherwise);
    if (!(value >= 0.0 && value <= 1.0)) refuse(key, "is outside 0 to 1");
    return value;
  }
  [[noreturn]] void refuse(const std::string& key, const std::string& cause) const {
    refuse(root_[key].Mark(), key + " " + cause);
  }

 private:
  /// A PNG or PGM itself, by its first bytes.
  void refuse_picture() const {
    char first[4] = {};
    std::ifstream(file_, std::ios::binary).read(first, sizeof first);
    const std::string bytes(first, sizeof first);
    if (bytes == "\x89PNG" || bytes.rfind("P5", 0) == 0 || bytes.rfind("P2", 0) == 0)
      throw StartupError(file_.string() + ": is a picture", "give the map_server YAML file that names it");
  }
  /// The library takes the first of them.
  void refuse_repeated_keys() const {
    std::set<std::string> known;
    for (const auto& entry : root_)
      if (!known.insert(entry.first.Scalar()).second)
        refuse(entry.first.Mark(), entry.first.Scalar() + " stands twice");
  }
  [[noreturn]] void refuse(const YAML::Mark& mark, const std::string& cause) const {
    throw StartupError(file_.string() + ":" + std::to_string(mark.line + 1) + ": " + cause,
                       "write it as map_server does");
  }

  std::filesystem::path file_;
  YAML::Node root_;
};

Pose2 read_origin(const MapYaml& yaml) {
  const auto origin = yaml.get<std::vector<double>>("origin");
  if (origin.size() != 3) yaml.refuse("origin", "is not [x, y, yaw]");
  for (const double value : origin)
    if (!(std::fabs(value) < 1e6)) yaml.refuse("origin", "holds what is no coordinate");
  return {origin[0], origin[1], wrap_angle(origin[2])};
}

/// In any case, as map_server takes it.
MapMode read_mode(const MapYaml& yaml) {
  std::string said = yaml.get<std::string>("mode", "trinary");
  std::transform(said.begin(), said.end(), said.begin(), [](unsigned char c) { return std::tolower(c); });
  if (said == "scale") return MapMode::kScale;
  if (said == "raw") return MapMode::kRaw;
  if (said != "trinary") yaml.refuse("mode", "is none of trinary, scale, raw");
  return MapMode::kTrinary;
}

RasterSettings read_settings(const std::filesystem::path& file) {
  const MapYaml yaml(file);
  RasterSettings settings;
  settings.image = yaml.get<std::string>("image");
  if (settings.image.is_relative()) settings.image = file.parent_path() / settings.image;
  if (!std::filesystem::is_regular_file(settings.image)) yaml.refuse("image", "names no file");
  settings.cell_m = yaml.get<double>("resolution");
  if (!(settings.cell_m >= 0.001 && settings.cell_m <= 10.0)) yaml.refuse("resolution", "is outside 0.001 to 10 m");
  settings.origin = read_origin(yaml);
  settings.rule.negate = yaml.get<int>("negate", 0) != 0;
  settings.rule.occupied_above = yaml.share("occupied_thresh", 0.65);
  settings.rule.free_below = yaml.share("free_thresh", 0.196);
  if (settings.rule.free_below > settings.rule.occupied_above) yaml.refuse("free_thresh", "is over occupied_thresh");
  settings.rule.mode = read_mode(yaml);
  return settings;
}

/// Edges along grid line `line`, which runs between rows or else between columns.
void add_edges_along(const Raster& raster, std::int32_t line, bool between_rows, std::vector<WallSegment>& edges) {
  const auto is_solid = [&](std::int32_t k, std::int32_t beside) {
    return between_rows ? raster.solid_cell(k, beside) : raster.solid_cell(beside, k);
  };
  const auto differs = [&](std::int32_t k) { return is_solid(k, line) != is_solid(k, line - 1); };
  const auto point = [&](std::int32_t k) {
    const Vec2 corner = between_rows ? Vec2{1.0 * k, 1.0 * line} : Vec2{1.0 * line, 1.0 * k};
    return raster.map_from_raster * (corner * raster.cell_m);
  };
  const std::int32_t length = between_rows ? raster.width : raster.height;
  for (std::int32_t k = 0; k < length; ++k) {
    if (!differs(k)) continue;
    const std::int32_t begin = k;
    while (k < length && differs(k)) ++k;
    edges.push_back({point(begin), point(k)});
  }
}

}  // namespace

WallMap load_wall_map(MapKind kind, const std::filesystem::path& file) {
  if (kind == MapKind::kAria) return load_aria_map(file);
  if (kind == MapKind::kCylinders) return load_cylinder_map(file);
  WallMap map;
  map.raster = load_raster(file);
  map.segments = edges_of(map.raster);
  return map;
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

Raster read_raster(const std::filesystem::path& image, const OccupancyRule& rule, double cell_m,
                   std::int32_t most_cells) {
  const std::unique_ptr<ImageFile> picture = open_image(image);
  const std::int32_t each = (std::max(picture->width, picture->height) + most_cells - 1) / most_cells;
  Raster raster{{}, cell_m * each, (picture->width + each - 1) / each, (picture->height + each - 1) / each, {}};
  const std::size_t columns = static_cast<std::size_t>(raster.width);
  raster.solid.assign(columns * static_cast<std::size_t>(raster.height), 0);
  raster.free.assign(raster.solid.size(), 1);
  std::vector<Pixel> pixels;
  for (std::int32_t above = picture->height - 1; above >= 0; --above) {  // rows from the bottom
    picture->next_row(pixels);
    const std::size_t begin = static_cast<std::size_t>(above / each) * columns;
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      const std::size_t cell = begin + k / static_cast<std::size_t>(each);
      const CellState state = state_of(pixels[k], rule);
      if (state.wall) raster.solid[cell] = 1;
      if (!state.free) raster.free[cell] = 0;
    }
  }
  return raster;
}

std::vector<WallSegment> edges_of(const Raster& raster) {
  std::vector<WallSegment> edges;
  for (std::int32_t row = 0; row <= raster.height; ++row) add_edges_along(raster, row, true, edges);
  for (std::int32_t column = 0; column <= raster.width; ++column) add_edges_along(raster, column, false, edges);
  return edges;
}

std::vector<std::filesystem::path> files_of_map(MapKind kind, const std::filesystem::path& file) {
  if (kind != MapKind::kYaml) return {file};
  return {file, read_settings(file).image};
}

Raster load_raster(const std::filesystem::path& yaml_file, std::int32_t most_cells) {
  const RasterSettings settings = read_settings(yaml_file);
  Raster raster = read_raster(settings.image, settings.rule, settings.cell_m, most_cells);
  raster.map_from_raster = settings.origin;
  return raster;
}

}  // namespace jaywalk::sim
