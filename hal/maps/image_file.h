#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
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

// The picture formats behind ImageFile.

class ImageFile::Rows {
 public:
  virtual ~Rows() = default;
  virtual void next(std::vector<Pixel>& row) = 0;

  std::int32_t width = 0, height = 0;

 protected:
  explicit Rows(std::filesystem::path file) : file_(std::move(file)) {}
  [[noreturn]] void refuse(const std::string& cause) const;
  void take_size(std::int64_t wide, std::int64_t high);

  std::filesystem::path file_;
};

[[nodiscard]] std::unique_ptr<ImageFile::Rows> png_rows(const std::filesystem::path& file);

}  // namespace jaywalk::sim
