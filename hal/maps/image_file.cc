#include "hal/maps/image_file.h"

#include <png.h>

#include <fstream>
#include <sstream>
#include <string>

#include "hal/types/errors.h"

namespace jaywalk::sim {
namespace {

constexpr std::int64_t kMaxPixels = 64'000'000;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& cause) {
  throw StartupError(file.string() + ": " + cause, "use a whole PNG or PGM picture");
}

void check_size(const std::filesystem::path& file, std::int64_t width, std::int64_t height) {
  if (width < 1 || height < 1) refuse(file, "no size stands in its first lines");
  if (width > kMaxPixels || height > kMaxPixels || width * height > kMaxPixels) {
    throw StartupError(file.string() + ": " + std::to_string(width) + " x " + std::to_string(height) +
                           " are more than 64 million pixels",
                       "take larger ones");
  }
}

GreyImage load_png(const std::filesystem::path& file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&png, file.string().c_str())) refuse(file, png.message);
  GreyImage image{static_cast<std::int32_t>(png.width), static_cast<std::int32_t>(png.height), {}};
  if (png.width > kMaxPixels || png.height > kMaxPixels ||
      static_cast<std::int64_t>(png.width) * png.height > kMaxPixels) {
    png_image_free(&png);
    check_size(file, png.width, png.height);
  }
  png.format = PNG_FORMAT_GRAY;
  image.grey.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  const png_color white{255, 255, 255};
  if (!png_image_finish_read(&png, &white, image.grey.data(), image.width, nullptr)) refuse(file, png.message);
  return image;
}

/// The next number of a PGM header; # starts a comment that ends with the line.
std::int64_t header_number(std::istream& in) {
  while ((in >> std::ws) && in.peek() == '#') in.ignore(kMaxPixels, '\n');
  std::int64_t value = -1;
  in >> value;
  return value;
}

/// One P5 sample; two bytes, the high one first, when the greatest value is above 255.
std::int64_t binary_sample(std::istream& in, std::int64_t greatest) {
  const std::int64_t high = in.get();
  return greatest > 255 ? high * 256 + in.get() : high;
}

GreyImage load_pgm(const std::filesystem::path& file, std::istream& in, bool binary) {
  const std::int64_t width = header_number(in), height = header_number(in), greatest = header_number(in);
  check_size(file, width, height);
  if (greatest < 1 || greatest > 65535) refuse(file, "a greatest grey value outside 1 to 65535");
  if (binary) in.get();  // the one white-space before the samples
  GreyImage image{static_cast<std::int32_t>(width), static_cast<std::int32_t>(height), {}};
  image.grey.reserve(static_cast<std::size_t>(width * height));
  for (std::int64_t k = 0; k < width * height; ++k) {
    const std::int64_t sample = binary ? binary_sample(in, greatest) : header_number(in);
    if (!in || sample < 0 || sample > greatest) refuse(file, "damaged at pixel " + std::to_string(k));
    image.grey.push_back(static_cast<std::uint8_t>((sample * 255 + greatest / 2) / greatest));
  }
  return image;
}

}  // namespace

GreyImage load_image(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  char magic[2] = {};
  if (!in.read(magic, 2)) refuse(file, "cannot be read");
  const std::string kind(magic, 2);
  if (kind == "P2" || kind == "P5") return load_pgm(file, in, kind == "P5");
  if (kind == "\x89P") return load_png(file);
  refuse(file, "neither PNG nor PGM");
}

}  // namespace jaywalk::sim
