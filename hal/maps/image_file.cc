#include "hal/maps/image_file.h"

#include <png.h>

#include <array>
#include <csetjmp>
#include <cstdio>
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

/// Those that are stored in seven passes are held whole.
constexpr std::uint64_t kMostHeldBytes = 512U << 20U;

struct PngStructs {
  PngStructs() = default;
  ~PngStructs() { png_destroy_read_struct(&read, &info, nullptr); }
  PngStructs(const PngStructs&) = delete;
  PngStructs& operator=(const PngStructs&) = delete;

  png_structp read = nullptr;
  png_infop info = nullptr;
};

/// PNG by libpng's rows. Its errors jump: no object with a destructor is made between setjmp and the calls.
class PngFile final : public ImageFile {
 public:
  explicit PngFile(const std::filesystem::path& file)
      : ImageFile(file), in_(std::fopen(file.c_str(), "rb"), &std::fclose) {
    if (!in_) refuse("cannot be read");
    png_.read = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &PngFile::jump, &PngFile::pass_over);
    png_.info = png_.read == nullptr ? nullptr : png_create_info_struct(png_.read);
    if (png_.info == nullptr || !succeed([this] { begin(); })) refuse_damaged();
    take_size(png_get_image_width(png_.read, png_.info), png_get_image_height(png_.read, png_.info));
    channels_ = png_get_channels(png_.read, png_.info);
    wide_samples_ = png_get_bit_depth(png_.read, png_.info) == 16;
    const std::size_t row_bytes = png_get_rowbytes(png_.read, png_.info);
    bytes_.resize(row_bytes);
    if (png_get_interlace_type(png_.read, png_.info) != PNG_INTERLACE_NONE) hold_all(row_bytes);
  }

  void next_row(std::vector<Pixel>& row) override {
    const png_byte* at = bytes_.data();
    if (lines_.empty()) {
      if (!succeed([this] { png_read_row(png_.read, bytes_.data(), nullptr); })) refuse_damaged();
    } else {
      at = lines_[read_++];
    }
    row.resize(static_cast<std::size_t>(width));
    for (Pixel& pixel : row) pixel = take_pixel(at);
  }

 private:
  [[noreturn]] static void jump(png_structp png, png_const_charp cause) {
    static_cast<PngFile*>(png_get_error_ptr(png))->cause_ = cause;
    png_longjmp(png, 1);
  }
  static void pass_over(png_structp /*png*/, png_const_charp /*warning*/) {}
  [[noreturn]] void refuse_damaged() const { refuse(cause_.empty() ? "libpng has no memory" : cause_); }

  /// False where one of libpng's calls has jumped.
  template <class Calls>
  bool succeed(const Calls& calls) {
    if (setjmp(png_jmpbuf(png_.read)) != 0) return false;
    calls();
    return true;
  }
  // Palettes, few bits and transparent colours become samples of 8 bits; gamma is left alone.
  void begin() {
    png_init_io(png_.read, in_.get());
    png_set_user_limits(png_.read, 0x7fffffff, 0x7fffffff);
    png_read_info(png_.read, png_.info);
    png_set_expand(png_.read);
    (void)png_set_interlace_handling(png_.read);
    png_read_update_info(png_.read, png_.info);
  }
  void hold_all(std::size_t row_bytes) {
    const std::uint64_t all = static_cast<std::uint64_t>(row_bytes) * static_cast<std::uint64_t>(height);
    if (all > kMostHeldBytes) refuse("interlaced, and more than 512 MiB unpacked: save it without interlacing");
    bytes_.resize(all);
    for (std::int32_t k = 0; k < height; ++k) lines_.push_back(bytes_.data() + static_cast<std::size_t>(k) * row_bytes);
    if (!succeed([this] { png_read_image(png_.read, lines_.data()); })) refuse_damaged();
  }

  std::uint32_t take_sample(const png_byte*& at) const {
    const std::uint32_t sample = wide_samples_ ? at[0] * 256U + at[1] : at[0] * 257U;
    at += wide_samples_ ? 2 : 1;
    return sample;
  }
  /// Grey counts as three channels alike, as map_server's own library makes of it.
  Pixel take_pixel(const png_byte*& at) const {
    const bool has_alpha = channels_ == 2 || channels_ == 4;
    const std::uint32_t colours = channels_ - (has_alpha ? 1U : 0U);
    std::uint32_t sum = 0;
    for (std::uint32_t k = 0; k < colours; ++k) sum += take_sample(at);
    if (colours == 1) sum *= 3;
    Pixel pixel;
    pixel.colour = pixel.with_alpha = static_cast<std::uint16_t>((sum + 1) / 3);
    if (!has_alpha) return pixel;
    const std::uint32_t alpha = take_sample(at);
    pixel.with_alpha = static_cast<std::uint16_t>((sum + alpha + 2) / 4);
    pixel.opaque = alpha == 65535;
    return pixel;
  }

  std::unique_ptr<std::FILE, int (*)(std::FILE*)> in_;
  PngStructs png_;
  std::string cause_;
  std::uint32_t channels_ = 1;
  bool wide_samples_ = false;
  std::vector<png_byte> bytes_;   ///< of one row, or all
  std::vector<png_bytep> lines_;  ///< of all, where they are held
  std::size_t read_ = 0;
};

}  // namespace

std::unique_ptr<ImageFile> open_image(const std::filesystem::path& file) {
  char magic[2] = {};
  if (!std::ifstream(file, std::ios::binary).read(magic, 2)) refuse_picture(file, "cannot be read");
  const std::string kind(magic, 2);
  if (kind == "P2" || kind == "P5") return std::make_unique<PgmFile>(file);
  if (kind == "\x89P") return std::make_unique<PngFile>(file);
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
