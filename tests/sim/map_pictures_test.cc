// Pictures of maps as nav2_map_server's map_io reads them.
#include <zlib.h>

#include "hal/maps/image_file.h"
#include "hal/maps/wall_map.h"
#include "tests/sim/made_worlds.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::sim;

namespace {

using Cells = std::vector<std::uint8_t>;

std::string high_first(std::uint32_t v) {
  return {static_cast<char>(v >> 24U), static_cast<char>(v >> 16U), static_cast<char>(v >> 8U), static_cast<char>(v)};
}

std::string chunk(const std::string& type, const std::string& bytes) {
  const std::string body = type + bytes;
  const auto crc = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  return high_first(static_cast<std::uint32_t>(bytes.size())) + body + high_first(static_cast<std::uint32_t>(crc));
}

/// One row; `kind`: PNG's colour type; `samples`: the row's bytes; `more`: chunks before the data.
std::string png(std::uint32_t width, int depth, int kind, const std::string& samples, const std::string& more = "") {
  std::string packed(compressBound(samples.size() + 1), '\0');
  uLongf size = packed.size();
  const std::string row = std::string(1, '\0') + samples;
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(row.data()), row.size());
  packed.resize(size);
  const std::string head =
      high_first(width) + high_first(1) + static_cast<char>(depth) + static_cast<char>(kind) + std::string(3, '\0');
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", head) + more + chunk("IDAT", packed) + chunk("IEND", "");
}

Raster read(const std::string& picture, const std::string& more = "") {
  folder().write("m.png", picture);
  const std::string text = "image: m.png\nresolution: 0.1\norigin: [0, 0, 0]\n" + more;
  return load_raster(folder().write("m.yaml", text));
}

constexpr int kGrey = 0, kColour = 2, kPalette = 3, kGreyAlpha = 4, kColourAlpha = 6;

std::vector<std::uint16_t> greys(const std::string& file) {
  const std::unique_ptr<ImageFile> image = open_image(file);
  std::vector<std::uint16_t> all;
  std::vector<Pixel> row;
  for (std::int32_t k = 0; k < image->height; ++k) {
    image->next_row(row);
    for (const Pixel& pixel : row) all.push_back(pixel.colour);
  }
  return all;
}

std::string low_first(std::uint32_t v, int bytes) {
  std::string text;
  for (int k = 0; k < bytes; ++k) text += k < 4 ? static_cast<char>(v >> (8 * k)) : '\0';
  return text;
}

/// Two rows, the lower one first; `lines` are padded to four bytes.
std::string bmp(std::uint32_t width, int bits, const std::string& palette, const std::string& lines, bool from_top) {
  const auto begin = static_cast<std::uint32_t>(54 + palette.size());
  return "BM" + low_first(0, 8) + low_first(begin, 4) + low_first(40, 4) + low_first(width, 4) +
         low_first(from_top ? 0xFFFFFFFEU : 2U, 4) + low_first(1, 2) + low_first(static_cast<std::uint32_t>(bits), 2) +
         low_first(0, 16) + low_first(static_cast<std::uint32_t>(palette.size() / 4), 4) + low_first(0, 4) + palette +
         lines;
}

}  // namespace

TEST_CASE("a BMP is read as map_saver writes it, with a palette or in colour, from the bottom or from the top") {
  const auto greys_of = [&](const std::string& bytes) { return greys(folder().write("m.bmp", bytes)); };
  const std::string palette{'\0', '\0', '\0', '\0', '\x33', '\x33', '\x33', '\0'};
  const std::vector<std::uint16_t> walls{0, 0x3333, 0x3333, 0x3333};
  CHECK(greys_of(bmp(2, 8, palette, std::string("\1\1\0\0\0\1\0\0", 8), false)) == walls);
  CHECK(greys_of(bmp(2, 8, palette, std::string("\0\1\0\0\1\1\0\0", 8), true)) == walls);
  CHECK(greys_of(bmp(2, 1, palette, std::string("\xC0\0\0\0\x40\0\0\0", 8), false)) == walls);
  const std::string colours(
      "\x33\x33\x33\x66\x33\0\0\0"
      "\0\0\0\x33\x33\x33\0\0",
      16);
  CHECK(greys_of(bmp(2, 24, "", colours, false)) == walls);
  CHECK_THROWS_WITH(greys_of(bmp(2, 24, "", "\1", false)), Catch::Contains("m.bmp: the picture is cut short"));
  CHECK_THROWS_WITH(greys_of(bmp(2, 16, "", colours, false)), Catch::Contains("m.bmp: a BMP of 16 bits a pixel"));
}

// Walls of mean 80 of 255 have an occupancy of 0.686, over 0.65: of 67 to 85 all are walls, and 205 is 0.196.
TEST_CASE("a wall is what map_server calls one, whatever the kind of PNG") {
  const std::string shades = {80, static_cast<char>(205), static_cast<char>(254), 0};
  const Cells walls{1, 0, 0, 1}, free{0, 0, 1, 0};
  std::string wide, rgb, rgb16, alpha;
  for (const char s : shades) wide += {s, s}, rgb += {s, s, s}, rgb16 += {s, s, s, s, s, s}, alpha += {s, '\xff'};
  for (const std::string& picture :
       {png(4, 8, kGrey, shades), png(4, 16, kGrey, wide), png(4, 8, kColour, rgb), png(4, 16, kColour, rgb16),
        png(4, 8, kGrey, shades, chunk("gAMA", high_first(100000))),
        png(4, 8, kGrey, shades, chunk("gAMA", high_first(45455)) + chunk("sRGB", std::string(1, '\0'))),
        png(4, 8, kPalette, std::string("\0\1\2\3", 4), chunk("PLTE", rgb))}) {
    const Raster raster = read(picture);
    CHECK(raster.solid == walls);
    CHECK(raster.free == free);
  }
}

TEST_CASE("colour counts by the plain mean of its channels, transparency as one more in mode trinary") {
  // Red 240, 0, 0 and green, blue alike: mean 80. Weighted for the eye green would be 172 and free of walls.
  const std::string colours("\xf0\0\0\0\xf0\0\0\0\xf0\xff\xff\xff", 12);
  CHECK(read(png(4, 8, kColour, colours)).solid == Cells{1, 1, 1, 0});
  // Black and opaque: (0 + 0 + 0 + 255) / 4 is 64. Dark grey 60 and opaque: 109 is no wall. Black, transparent: wall.
  const std::string alpha("\0\xff\x3c\xff\0\0\xff\xff", 8);
  CHECK(read(png(4, 8, kGreyAlpha, alpha)).solid == Cells{1, 0, 1, 0});
  CHECK(read(png(4, 8, kGreyAlpha, alpha), "mode: scale\n").solid == Cells{1, 1, 0, 0});
  CHECK(read(png(4, 8, kGreyAlpha, alpha), "mode: scale\n").free == Cells{0, 0, 0, 1});
  const std::string rgba("\0\0\0\xff\xff\xff\xff\xff", 8);
  CHECK(read(png(2, 8, kColourAlpha, rgba)).solid == Cells{1, 0});
}

TEST_CASE("the modes are read in any case, and raw takes brightness for per cent") {
  const std::string shades("\0\x42\x64\xff", 4);  // 0, 66, 100, 255
  for (const char* mode : {"trinary", "Trinary", "TRINARY", "Scale", "scale"})
    CHECK(read(png(4, 8, kGrey, shades), std::string("mode: ") + mode + "\n").solid == Cells{1, 1, 0, 0});
  const Raster raw = read(png(4, 8, kGrey, shades), "mode: Raw\n");
  CHECK(raw.solid == Cells{0, 1, 1, 0});
  CHECK(raw.free == Cells{1, 0, 0, 0});
}

TEST_CASE("binary, 16 bit and commented PGM give the same picture as plain text") {
  const std::vector<std::uint16_t> expected{0, 65535, 128 * 257, 7 * 257};
  CHECK(greys(folder().write("a.pgm", "P2\n# made by hand\n2 2 # wide, high\n255\n0 255 128 7\n")) == expected);
  CHECK(greys(folder().write("b.pgm", std::string("P5 2 2 255\n\x00\xff\x80\x07", 15))) == expected);
  // 128 of 255 is 32896 = 0x8080 of 65535, and 7 is 1799 = 0x0707.
  CHECK(greys(folder().write("c.pgm", std::string("P5 2 2 65535\n\x00\x00\xff\xff\x80\x80\x07\x07", 21))) == expected);
}

TEST_CASE("a map of more cells than are wanted is read in larger ones: a wall where a pixel is, free where all are") {
  // Seven by three pixels, one wall at the top right corner and one unknown pixel at the bottom left.
  folder().write("m.pgm",
                 "P2 7 3 255  255 255 255 255 255 255 0  255 255 255 255 255 255 255  205 255 255 255 255 255 255");
  const auto yaml = folder().write("m.yaml", "image: m.pgm\nresolution: 0.1\norigin: [1, 2, 0]\n");
  const Raster raster = load_raster(yaml, 4);
  CHECK(raster.width == 4);
  CHECK(raster.height == 2);
  CHECK(raster.cell_m == Approx(0.2));
  CHECK(raster.map_from_raster == Pose2{1, 2, 0});
  CHECK(raster.solid == Cells{0, 0, 0, 0, 0, 0, 0, 1});
  CHECK(raster.free == Cells{0, 1, 1, 1, 1, 1, 1, 0});
  CHECK(load_raster(yaml).width == 7);
}

TEST_CASE("a damaged PNG is refused in words, wherever it was cut") {
  const std::string whole = png(4, 8, kGrey, "abcd");
  for (std::size_t bytes = 2; bytes + 20 < whole.size(); ++bytes) {
    const std::string file = folder().write("cut.png", whole.substr(0, bytes));
    CHECK(holds(refusal_of([&] { return greys(file); }), "cut.png: "));
  }
}
