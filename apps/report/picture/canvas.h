#pragma once
// A sheet to draw on, in pixels from its upper left corner, x to the right and y down.
#include <cairo.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/types/geometry.h"

namespace jaywalk {
/// Each in [0, 1].
struct Colour {
  double red = 0.0, green = 0.0, blue = 0.0, opacity = 1.0;

  [[nodiscard]] constexpr Colour faded(double to_opacity) const { return {red, green, blue, to_opacity}; }
};

/// 0xRRGGBB.
[[nodiscard]] constexpr Colour colour(std::uint32_t rgb) {
  return {static_cast<double>(rgb >> 16U & 0xFFU) / 255.0, static_cast<double>(rgb >> 8U & 0xFFU) / 255.0,
          static_cast<double>(rgb & 0xFFU) / 255.0, 1.0};
}

struct Pen {
  Colour colour;
  double width = 1.0;
  double dash = 0.0;  ///< length of dashes and of the gaps between them; 0: none
};

enum class Align { kLeft, kCentre, kRight };

struct Lettering {
  double size = 20.0;
  Colour colour;
  Align align = Align::kLeft;
  bool bold = false;
};

using Polyline = std::vector<Vec2>;

/// Loads the shared library of that name for as long as the program runs: a robot's program starts without cairo, and
/// without the X11 and font libraries that it brings. Null where it is not installed or no cairo. Not for the loop.
[[nodiscard]] void* load_cairo(const char* name = "libcairo.so.2");

class Canvas {
 public:
  /// A white sheet. Throws std::bad_alloc.
  Canvas(int width, int height);

  void fill(const Polyline& outline, const Colour& colour);
  void stroke(const Polyline& line, const Pen& pen, bool closed = false);
  void fill_disc(Vec2 centre, double radius, const Colour& colour);
  /// Fills it and draws its rim.
  void draw_disc(Vec2 centre, double radius, const Colour& colour, const Pen& rim);
  /// `at` is the baseline's left end, middle or right end.
  void write(Vec2 at, const std::string& text, const Lettering& lettering);
  /// Draws pixels (opaque or not, row by row from the top) stretched over a rectangle.
  void image(const std::vector<Colour>& pixels, int width, int height, Vec2 upper_left, Vec2 size);
  /// Until unclip() only what lies inside the rectangle is drawn.
  void clip(Vec2 upper_left, Vec2 size);
  void unclip();

  /// Throws StartupError when the file cannot be written.
  void save_png(const std::string& file) const;

 private:
  std::shared_ptr<cairo_surface_t> surface_;
  std::shared_ptr<cairo_t> cairo_;
  cairo_t* to_;  ///< draws on the surface
};

}  // namespace jaywalk
