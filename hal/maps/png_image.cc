// PNG by libpng's rows. Its errors jump: no object with a destructor is made between setjmp and the calls.
#include <png.h>

#include <csetjmp>
#include <cstdio>

#include "hal/maps/image_file.h"

namespace jaywalk::sim {
namespace {

/// Those that are stored in seven passes are held whole.
constexpr std::uint64_t kMostHeldBytes = 512U << 20U;

struct ClosesFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

struct PngStructs {
  PngStructs() = default;
  ~PngStructs() { png_destroy_read_struct(&read, &info, nullptr); }
  PngStructs(const PngStructs&) = delete;
  PngStructs& operator=(const PngStructs&) = delete;

  png_structp read = nullptr;
  png_infop info = nullptr;
};

class PngFile final : public ImageFile {
 public:
  explicit PngFile(const std::filesystem::path& file) : ImageFile(file), in_(std::fopen(file.c_str(), "rb")) {
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

  std::unique_ptr<std::FILE, ClosesFile> in_;
  PngStructs png_;
  std::string cause_;
  std::uint32_t channels_ = 1;
  bool wide_samples_ = false;
  std::vector<png_byte> bytes_;   ///< of one row, or all
  std::vector<png_bytep> lines_;  ///< of all, where they are held
  std::size_t read_ = 0;
};

}  // namespace

std::unique_ptr<ImageFile> open_png(const std::filesystem::path& file) { return std::make_unique<PngFile>(file); }

}  // namespace jaywalk::sim
