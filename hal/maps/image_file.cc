#include "hal/maps/image_file.h"

#include <array>
#include <fstream>

#include "hal/types/errors.h"

namespace jaywalk::sim {
namespace {

constexpr std::int64_t kMostPixels = 3'000'000'000;  // 500 m a side in cells of 1 cm are 2,500 million

[[noreturn]] void refuse_picture(const std::filesystem::path& file, const std::string& cause) {
  throw StartupError(file.string() + ": " + cause, "use a whole PNG, PGM or BMP picture");
}

constexpr std::streamsize kLongestComment = 1'000'000;

class PgmFile final : public ImageFile {
 public:
  explicit PgmFile(const std::filesystem::path& file) : ImageFile(file), in_(file, std::ios::binary) {
    char magic[2] = {};
    in_.read(magic, sizeof magic);
    binary_ = magic[1] == '5';
    const std::int64_t wide = text_number(), high = text_number();
    greatest_ = text_number();
    take_size(wide, high);
    if (greatest_ < 1 || greatest_ > 65535) refuse("a greatest grey value outside 1 to 65535");
    if (binary_) in_.get();  // the one white-space before the samples
  }

  void next_row(std::vector<Pixel>& row) override {
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

constexpr std::uint32_t kUncompressed = 0, kBitFields = 3;
constexpr std::size_t kHead = 54;  ///< of the file and of the picture; longer ones say the same first

/// A palette of up to 8 bits a pixel, or 24 or 32 bits; rows from the bottom unless the height is negative.
class BmpFile final : public ImageFile {
 public:
  explicit BmpFile(const std::filesystem::path& file) : ImageFile(file), in_(file, std::ios::binary) {
    std::array<unsigned char, kHead> head{};
    read(head.data(), head.size());
    const auto number = [&](std::size_t at, std::size_t bytes) {
      std::uint32_t value = 0;
      while (bytes-- > 0) value = value << 8U | head.at(at + bytes);
      return value;
    };
    const auto high = static_cast<std::int32_t>(number(22, 4));
    from_top_ = high < 0;
    take_size(static_cast<std::int32_t>(number(18, 4)), from_top_ ? -std::int64_t{high} : high);
    begin_ = number(10, 4);
    bits_ = number(28, 2);
    const std::uint32_t packed = number(30, 4);
    const bool has_palette = bits_ == 1 || bits_ == 4 || bits_ == 8;
    if (!has_palette && bits_ != 24 && bits_ != 32) refuse("a BMP of " + std::to_string(bits_) + " bits a pixel");
    if (packed != kUncompressed && !(packed == kBitFields && bits_ == 32)) refuse("a compressed BMP");
    line_.resize((static_cast<std::size_t>(width) * bits_ + 31) / 32 * 4);
    if (!has_palette) return;
    in_.seekg(static_cast<std::streamoff>(14U + number(14, 4)));
    const std::uint32_t colours = number(46, 4);
    palette_.resize(colours == 0 || colours > 256 ? std::size_t{1} << bits_ : colours);
    std::array<unsigned char, 4> entry{};
    for (std::uint16_t& colour : palette_) {
      read(entry.data(), entry.size());
      colour = mean(entry.data());
    }
  }

  void next_row(std::vector<Pixel>& row) override {
    const std::int64_t from_begin = from_top_ ? next_ : height - 1 - next_;
    ++next_;
    in_.seekg(static_cast<std::streamoff>(begin_ + from_begin * static_cast<std::int64_t>(line_.size())));
    read(line_.data(), line_.size());
    row.clear();
    for (std::size_t k = 0; k < static_cast<std::size_t>(width); ++k) {
      const std::uint16_t colour = colour_of(k);
      row.push_back({colour, colour, true});
    }
  }

 private:
  void read(unsigned char* to, std::size_t bytes) {
    if (!in_.read(reinterpret_cast<char*>(to), static_cast<std::streamsize>(bytes))) refuse("the picture is cut short");
  }
  static std::uint16_t mean(const unsigned char* blue_green_red) {
    const unsigned sum = 0U + blue_green_red[0] + blue_green_red[1] + blue_green_red[2];
    return static_cast<std::uint16_t>(sum * 257U / 3U);
  }
  [[nodiscard]] std::uint16_t colour_of(std::size_t k) const {
    if (palette_.empty()) return mean(line_.data() + k * bits_ / 8);
    const std::size_t bit = k * bits_;
    const unsigned index = (static_cast<unsigned>(line_[bit / 8]) >> (8 - bits_ - bit % 8)) & ((1U << bits_) - 1U);
    if (index >= palette_.size()) refuse("a colour that its palette lacks");
    return palette_[index];
  }

  std::ifstream in_;
  bool from_top_ = false;
  std::int64_t begin_ = 0, next_ = 0;
  std::uint32_t bits_ = 0;
  std::vector<std::uint16_t> palette_;
  std::vector<unsigned char> line_;
};

}  // namespace

std::unique_ptr<ImageFile> open_image(const std::filesystem::path& file) {
  char magic[2] = {};
  if (!std::ifstream(file, std::ios::binary).read(magic, 2)) refuse_picture(file, "cannot be read");
  const std::string kind(magic, 2);
  if (kind == "P2" || kind == "P5") return std::make_unique<PgmFile>(file);
  if (kind == "\x89P") return open_png(file);
  if (kind == "BM") return std::make_unique<BmpFile>(file);
  refuse_picture(file, "neither PNG nor PGM nor BMP");
}

void ImageFile::refuse(const std::string& cause) const { refuse_picture(file_, cause); }

void ImageFile::take_size(std::int64_t wide, std::int64_t high) {
  if (wide < 1 || high < 1) refuse("no size stands in its first lines");
  if (wide > kMostPixels || high > kMostPixels || wide * high > kMostPixels) {
    throw StartupError(file_.string() + ": " + std::to_string(wide) + " x " + std::to_string(high) +
                           " are more than 3,000 million pixels",
                       "take larger ones");
  }
  width = static_cast<std::int32_t>(wide), height = static_cast<std::int32_t>(high);
}

}  // namespace jaywalk::sim
