#include "hal/maps/image_file.h"

#include <fstream>
#include <string>

#include "hal/types/errors.h"

namespace jaywalk::sim {
namespace {

constexpr std::int64_t kMostPixels = 3'000'000'000;  // 500 m a side in cells of 1 cm are 2,500 million

[[noreturn]] void refuse_picture(const std::filesystem::path& file, const std::string& cause) {
  throw StartupError(file.string() + ": " + cause, "use a whole PNG, PGM or BMP picture");
}

std::unique_ptr<ImageFile::Rows> rows_of(const std::filesystem::path& file) {
  char magic[2] = {};
  if (!std::ifstream(file, std::ios::binary).read(magic, 2)) refuse_picture(file, "cannot be read");
  const std::string kind(magic, 2);
  if (kind == "P2" || kind == "P5") return pgm_rows(file);
  if (kind == "\x89P") return png_rows(file);
  if (kind == "BM") return bmp_rows(file);
  refuse_picture(file, "neither PNG nor PGM nor BMP");
}

}  // namespace

void ImageFile::Rows::refuse(const std::string& cause) const { refuse_picture(file_, cause); }

void ImageFile::Rows::take_size(std::int64_t wide, std::int64_t high) {
  if (wide < 1 || high < 1) refuse("no size stands in its first lines");
  if (wide > kMostPixels || high > kMostPixels || wide * high > kMostPixels) {
    throw StartupError(file_.string() + ": " + std::to_string(wide) + " x " + std::to_string(high) +
                           " are more than 3,000 million pixels",
                       "take larger ones");
  }
  width = static_cast<std::int32_t>(wide), height = static_cast<std::int32_t>(high);
}

ImageFile::ImageFile(const std::filesystem::path& file) : rows_(rows_of(file)) {}
ImageFile::~ImageFile() = default;
std::int32_t ImageFile::width() const { return rows_->width; }
std::int32_t ImageFile::height() const { return rows_->height; }
void ImageFile::next_row(std::vector<Pixel>& row) { rows_->next(row); }

}  // namespace jaywalk::sim
