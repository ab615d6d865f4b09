#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

namespace jaywalk::sim {

/// Grey values, row by row from the top as in the picture; 0 black, 255 white.
struct GreyImage {
  std::int32_t width = 0;
  std::int32_t height = 0;
  std::vector<std::uint8_t> grey;
};

/// Reads PNG (colour becomes grey, transparency lies on white) or PGM (P2, P5, 8 or 16 bit). Throws StartupError
/// "FILE: cause; remedy" for anything else, a damaged file, or more than 64 million pixels.
[[nodiscard]] GreyImage load_image(const std::filesystem::path& file);

}  // namespace jaywalk::sim
