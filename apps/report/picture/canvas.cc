#include "apps/report/picture/canvas.h"

#include <dlfcn.h>

#include <cmath>
#include <cstdio>
#include <new>

#include "hal/types/errors.h"

// Read by the leak checker alone, in builds that have it: fontconfig keeps what it has read until the
// program ends, behind offsets that the checker takes for numbers.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig\n"; }

namespace jaywalk {
namespace {
/// Throws StartupError where cairo is not installed.
template <class Function>
Function cairo_function(const char* name) {
  static void* const library = load_cairo();
  void* const found = library == nullptr ? nullptr : ::dlsym(library, name);
  if (found == nullptr)
    throw StartupError("libcairo.so.2 is not installed", "apt-get install libcairo2 fonts-dejavu-core");
  return reinterpret_cast<Function>(found);
}

/// A function of cairo.h, without its prefix, looked for once.
#define JAYWALK_CAIRO(name)                                                              \
  ([] {                                                                                  \
    static const auto found = cairo_function<decltype(&::cairo_##name)>("cairo_" #name); \
    return found;                                                                        \
  }())

std::shared_ptr<cairo_surface_t> new_surface(cairo_format_t format, int width, int height) {
  return {JAYWALK_CAIRO(image_surface_create)(format, width, height), JAYWALK_CAIRO(surface_destroy)};
}

/// Cairo's own pixel: alpha, red, green, blue in 8 bits each, colours multiplied by alpha.
std::uint32_t argb(const Colour& c) {
  const auto eight_bits = [](double value) { return static_cast<std::uint32_t>(std::lround(value * 255.0)); };
  return eight_bits(c.opacity) << 24U | eight_bits(c.red * c.opacity) << 16U | eight_bits(c.green * c.opacity) << 8U |
         eight_bits(c.blue * c.opacity);
}

std::shared_ptr<cairo_surface_t> surface_of(const std::vector<Colour>& pixels, int width, int height) {
  std::shared_ptr<cairo_surface_t> surface = new_surface(CAIRO_FORMAT_ARGB32, width, height);
  if (JAYWALK_CAIRO(surface_status)(surface.get()) != CAIRO_STATUS_SUCCESS) throw std::bad_alloc();
  unsigned char* row = JAYWALK_CAIRO(image_surface_get_data)(surface.get());
  auto pixel = pixels.begin();
  for (int y = 0; y < height; ++y, row += JAYWALK_CAIRO(image_surface_get_stride)(surface.get())) {
    auto* argb_row = reinterpret_cast<std::uint32_t*>(row);  // cairo aligns its rows
    for (int x = 0; x < width; ++x) argb_row[x] = argb(*pixel++);
  }
  JAYWALK_CAIRO(surface_mark_dirty)(surface.get());
  return surface;
}

void trace(cairo_t* to, const Polyline& line) {
  JAYWALK_CAIRO(new_path)(to);
  for (const Vec2 p : line) JAYWALK_CAIRO(line_to)(to, p.x, p.y);
}

void trace_circle(cairo_t* to, Vec2 centre, double radius) {
  JAYWALK_CAIRO(new_path)(to);
  JAYWALK_CAIRO(arc)(to, centre.x, centre.y, radius, 0.0, 2.0 * kPi);
}

void use(cairo_t* to, const Colour& c) { JAYWALK_CAIRO(set_source_rgba)(to, c.red, c.green, c.blue, c.opacity); }

void fill_path(cairo_t* to, const Colour& colour) {
  use(to, colour);
  JAYWALK_CAIRO(fill)(to);
}

void stroke_path(cairo_t* to, const Pen& pen) {
  use(to, pen.colour);
  JAYWALK_CAIRO(set_line_width)(to, pen.width);
  JAYWALK_CAIRO(set_dash)(to, &pen.dash, pen.dash > 0.0 ? 1 : 0, 0.0);
  JAYWALK_CAIRO(stroke)(to);
}

}  // namespace

void* load_cairo(const char* name) {
  void* const library = ::dlopen(name, RTLD_NOW | RTLD_LOCAL);  // never unloaded: fontconfig keeps what it has read
  return library != nullptr && ::dlsym(library, "cairo_create") != nullptr ? library : nullptr;
}

Canvas::Canvas(int width, int height)
    : surface_(new_surface(CAIRO_FORMAT_RGB24, width, height)),
      cairo_(JAYWALK_CAIRO(create)(surface_.get()), JAYWALK_CAIRO(destroy)),
      to_(cairo_.get()) {
  if (JAYWALK_CAIRO(status)(to_) != CAIRO_STATUS_SUCCESS) throw std::bad_alloc();
  use(to_, colour(0xFFFFFF));
  JAYWALK_CAIRO(paint)(to_);
  JAYWALK_CAIRO(set_line_join)(to_, CAIRO_LINE_JOIN_ROUND);
  cairo_font_options_t* const options = JAYWALK_CAIRO(font_options_create)();
  JAYWALK_CAIRO(font_options_set_antialias)(options, CAIRO_ANTIALIAS_GRAY);
  JAYWALK_CAIRO(font_options_set_hint_style)(options, CAIRO_HINT_STYLE_NONE);  // the same on every screen and printer
  JAYWALK_CAIRO(font_options_set_hint_metrics)(options, CAIRO_HINT_METRICS_OFF);
  JAYWALK_CAIRO(set_font_options)(to_, options);
  JAYWALK_CAIRO(font_options_destroy)(options);
}

void Canvas::fill(const Polyline& outline, const Colour& colour) {
  trace(to_, outline);
  fill_path(to_, colour);
}

void Canvas::stroke(const Polyline& line, const Pen& pen, bool closed) {
  trace(to_, line);
  if (closed) JAYWALK_CAIRO(close_path)(to_);
  stroke_path(to_, pen);
}

void Canvas::fill_disc(Vec2 centre, double radius, const Colour& colour) {
  trace_circle(to_, centre, radius);
  fill_path(to_, colour);
}

void Canvas::draw_disc(Vec2 centre, double radius, const Colour& colour, const Pen& rim) {
  fill_disc(centre, radius, colour);
  trace_circle(to_, centre, radius);
  stroke_path(to_, rim);
}

void Canvas::write(Vec2 at, const std::string& text, const Lettering& lettering) {
  const auto weight = lettering.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL;
  JAYWALK_CAIRO(select_font_face)(to_, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, weight);
  JAYWALK_CAIRO(set_font_size)(to_, lettering.size);
  use(to_, lettering.colour);
  cairo_text_extents_t extents;
  JAYWALK_CAIRO(text_extents)(to_, text.c_str(), &extents);
  const double share = lettering.align == Align::kLeft ? 0.0 : lettering.align == Align::kRight ? 1.0 : 0.5;
  JAYWALK_CAIRO(move_to)(to_, at.x - share * extents.x_advance, at.y);
  JAYWALK_CAIRO(show_text)(to_, text.c_str());
}

void Canvas::image(const std::vector<Colour>& pixels, int width, int height, Vec2 upper_left, Vec2 size) {
  const std::shared_ptr<cairo_surface_t> picture = surface_of(pixels, width, height);
  JAYWALK_CAIRO(save)(to_);
  JAYWALK_CAIRO(translate)(to_, upper_left.x, upper_left.y);
  JAYWALK_CAIRO(scale)(to_, size.x / width, size.y / height);
  JAYWALK_CAIRO(set_source_surface)(to_, picture.get(), 0.0, 0.0);
  JAYWALK_CAIRO(pattern_set_filter)(JAYWALK_CAIRO(get_source)(to_), CAIRO_FILTER_BILINEAR);
  JAYWALK_CAIRO(paint)(to_);
  JAYWALK_CAIRO(restore)(to_);
}

void Canvas::clip(Vec2 upper_left, Vec2 size) {
  JAYWALK_CAIRO(save)(to_);
  JAYWALK_CAIRO(rectangle)(to_, upper_left.x, upper_left.y, size.x, size.y);
  JAYWALK_CAIRO(clip)(to_);
}

void Canvas::unclip() { JAYWALK_CAIRO(restore)(to_); }

void Canvas::save_png(const std::string& file) const {
  const cairo_status_t status = JAYWALK_CAIRO(surface_write_to_png)(surface_.get(), file.c_str());
  if (status != CAIRO_STATUS_SUCCESS) {
    std::remove(file.c_str());  // half a picture is none
    throw StartupError(file + ": " + JAYWALK_CAIRO(status_to_string)(status),
                       "choose an --out folder that may be written");
  }
}

}  // namespace jaywalk
