#include "hal/maps/wall_map.h"

namespace jaywalk::sim {

WallMap load_wall_map(MapKind kind, const std::filesystem::path& file) {
  switch (kind) {
    case MapKind::kAria:
      return load_aria_map(file);
    case MapKind::kCylinders:
      return load_cylinder_map(file);
    case MapKind::kYaml:
      break;
  }
  return load_raster_map(file);
}

std::vector<std::filesystem::path> files_of_map(MapKind kind, const std::filesystem::path& file) {
  if (kind != MapKind::kYaml) return {file};
  return {file, picture_of_raster_map(file)};
}

}  // namespace jaywalk::sim
