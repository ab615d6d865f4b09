#include <fstream>

#include "hal/maps/image_file.h"

namespace jaywalk::sim {
namespace {

constexpr std::streamsize kLongestComment = 1'000'000;

class PgmRows final : public ImageFile::Rows {
 public:
  explicit PgmRows(const std::filesystem::path& file) : Rows(file), in_(file, std::ios::binary) {
    char magic[2] = {};
    in_.read(magic, sizeof magic);
    binary_ = magic[1] == '5';
    const std::int64_t wide = text_number(), high = text_number();
    greatest_ = text_number();
    take_size(wide, high);
    if (greatest_ < 1 || greatest_ > 65535) refuse("a greatest grey value outside 1 to 65535");
    if (binary_) in_.get();  // the one white-space before the samples
  }

  void next(std::vector<Pixel>& row) override {
    row.resize(static_cast<std::size_t>(width));
    for (Pixel& pixel : row) {
      const std::int64_t sample = binary_ ? binary_sample() : text_number();
      if (!in_ || sample < 0 || sample > greatest_) refuse("damaged at pixel " + std::to_string(read_));
      ++read_;
      pixel.colour = static_cast<std::uint16_t>((sample * 65535 + greatest_ / 2) / greatest_);
      pixel.with_alpha = pixel.colour;
    }
  }

 private:
  /// The next number; # starts a comment that ends with the line.
  std::int64_t text_number() {
    while ((in_ >> std::ws) && in_.peek() == '#') in_.ignore(kLongestComment, '\n');
    std::int64_t value = -1;
    in_ >> value;
    return value;
  }
  /// Two bytes, the high one first, where the greatest value is above 255.
  std::int64_t binary_sample() {
    const std::int64_t high = in_.get();
    return greatest_ > 255 ? high * 256 + in_.get() : high;
  }

  std::ifstream in_;
  bool binary_ = false;
  std::int64_t greatest_ = 0, read_ = 0;
};

}  // namespace

std::unique_ptr<ImageFile::Rows> pgm_rows(const std::filesystem::path& file) { return std::make_unique<PgmRows>(file); }

}  // namespace jaywalk::sim
