#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

namespace jaywalk::sim {

/// How bright a pixel is, 0 black to 65535 white: the mean of its channels as they stand in the file, in its own bit
/// depth (no gamma, no weights), as map_server has it.
struct Pixel {
  std::uint16_t colour = 0;      ///< of the channels without transparency
  std::uint16_t with_alpha = 0;  ///< of all, transparency among them; `colour` where there is none
  bool opaque = true;
};

/// A PNG (of any kind), PGM (P2, P5, 8 or 16 bit) or BMP (uncompressed) picture, read a row at a time: a map of
/// gigapixels takes a row's memory.
class ImageFile {
 public:
  /// Throws StartupError "FILE: cause; remedy" for anything else, or more than 3,000 million pixels.
  explicit ImageFile(const std::filesystem::path& file);
  ~ImageFile();
  ImageFile(const ImageFile&) = delete;
  ImageFile& operator=(const ImageFile&) = delete;

  [[nodiscard]] std::int32_t width() const;
  [[nodiscard]] std::int32_t height() const;
  /// The next row from the top, of width() pixels; at most height() of them. Throws StartupError where it is damaged.
  void next_row(std::vector<Pixel>& row);

  /// One of the formats.
  class Rows;

 private:
  std::unique_ptr<Rows> rows_;
};

}  // namespace jaywalk::sim
