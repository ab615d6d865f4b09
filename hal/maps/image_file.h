#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hal/maps/wall_map.h"

namespace jaywalk::sim {

/// How bright a pixel is, 0 black to 65535 white: the mean of its channels as they stand in the file, in its own bit
/// depth (no gamma, no weights), as map_server has it.
struct Pixel {
  std::uint16_t colour = 0;      ///< of the channels without transparency
  std::uint16_t with_alpha = 0;  ///< of all, transparency among them; `colour` where there is none
  bool opaque = true;
};

/// A picture, read a row at a time: a map of gigapixels takes a row's memory.
class ImageFile {
 public:
  virtual ~ImageFile() = default;
  /// The next row from the top, of `width` pixels; at most `height` of them. Throws StartupError where it is damaged.
  virtual void next_row(std::vector<Pixel>& row) = 0;

  std::int32_t width = 0, height = 0;

 protected:
  explicit ImageFile(std::filesystem::path file) : file_(std::move(file)) {}
  [[noreturn]] void refuse(const std::string& cause) const;
  void take_size(std::int64_t wide, std::int64_t high);

  std::filesystem::path file_;
};

/// A PNG (of any kind), PGM (P2, P5, 8 or 16 bit) or BMP (uncompressed) picture. Throws StartupError
/// "FILE: cause; remedy" for anything else, or more than 3,000 million pixels.
[[nodiscard]] std::unique_ptr<ImageFile> open_image(const std::filesystem::path& file);

// Cells of a picture that are walls.

/// map_server's modes (nav2_map_server's map_io): what a pixel's brightness says.
enum class MapMode : std::uint8_t {
  kTrinary,  ///< wall, free or unknown; transparency counts as a channel
  kScale,    ///< the same, shades between are unknown here; what is transparent is unknown
  kRaw       ///< brightness 0 to 100 of 255 is the occupancy in per cent, more is unknown; `negate` is no matter
};

struct OccupancyRule {
  MapMode mode = MapMode::kTrinary;
  bool negate = false;
  double occupied_above = 0.65, free_below = 0.196;
};

/// The picture's cells of `cell_m`, their frame at its lower left corner. Where it has more than `most_cells` a side,
/// squares of k x k of its pixels become a cell: a wall where one of them is, free where all of them are.
[[nodiscard]] Raster read_raster(const std::filesystem::path& image, const OccupancyRule& rule, double cell_m,
                                 std::int32_t most_cells);

}  // namespace jaywalk::sim
