#include "hal/maps/occupancy.h"

#include <algorithm>
#include <cmath>

#include "hal/maps/image_file.h"

namespace jaywalk::sim {
namespace {

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

}  // namespace

Raster read_raster(const std::filesystem::path& image, const OccupancyRule& rule, double cell_m,
                   std::int32_t most_cells) {
  ImageFile picture(image);
  const std::int32_t each = (std::max(picture.width(), picture.height()) + most_cells - 1) / most_cells;
  Raster raster{{}, cell_m * each, (picture.width() + each - 1) / each, (picture.height() + each - 1) / each, {}};
  const std::size_t columns = static_cast<std::size_t>(raster.width);
  raster.solid.assign(columns * static_cast<std::size_t>(raster.height), 0);
  raster.free.assign(raster.solid.size(), 1);
  std::vector<Pixel> pixels;
  for (std::int32_t above = picture.height() - 1; above >= 0; --above) {  // rows from the bottom
    picture.next_row(pixels);
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

}  // namespace jaywalk::sim
