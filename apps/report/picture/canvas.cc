#include "apps/report/picture/canvas.h"

#include <cairo.h>
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

struct Release {
  void operator()(cairo_surface_t* surface) const { JAYWALK_CAIRO(surface_destroy)(surface); }
  void operator()(cairo_t* context) const { JAYWALK_CAIRO(destroy)(context); }
  void operator()(cairo_font_options_t* options) const { JAYWALK_CAIRO(font_options_destroy)(options); }
};
using Surface = std::unique_ptr<cairo_surface_t, Release>;

/// Cairo's own pixel: alpha, red, green, blue in 8 bits each, colours multiplied by alpha.
std::uint32_t argb(const Colour& c) {
  const auto eight_bits = [](double value) { return static_cast<std::uint32_t>(std::lround(value * 255.0)); };
  return eight_bits(c.opacity) << 24U | eight_bits(c.red * c.opacity) << 16U | eight_bits(c.green * c.opacity) << 8U |
         eight_bits(c.blue * c.opacity);
}

Surface surface_of(const std::vector<Colour>& pixels, int width, int height) {
  Surface surface(JAYWALK_CAIRO(image_surface_create)(CAIRO_FORMAT_ARGB32, width, height));
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

}  // namespace

void* load_cairo(const char* name) {
  void* const library = ::dlopen(name, RTLD_NOW | RTLD_LOCAL);  // never unloaded: fontconfig keeps what it has read
  return library != nullptr && ::dlsym(library, "cairo_create") != nullptr ? library : nullptr;
}

struct Canvas::Cairo {
  Surface surface;
  std::unique_ptr<cairo_t, Release> owned;
  cairo_t* to;  ///< what is drawn to

  Cairo(int width, int height)
      : surface(JAYWALK_CAIRO(image_surface_create)(CAIRO_FORMAT_RGB24, width, height)),
        owned(JAYWALK_CAIRO(create)(surface.get())),
        to(owned.get()) {
    if (JAYWALK_CAIRO(status)(to) != CAIRO_STATUS_SUCCESS) throw std::bad_alloc();
  }
  void trace(const Polyline& line) const {
    JAYWALK_CAIRO(new_path)(to);
    for (const Vec2 p : line) JAYWALK_CAIRO(line_to)(to, p.x, p.y);
  }
  void trace_circle(Vec2 centre, double radius) const {
    JAYWALK_CAIRO(new_path)(to);
    JAYWALK_CAIRO(arc)(to, centre.x, centre.y, radius, 0.0, 2.0 * kPi);
  }
  void use(const Colour& c) const { JAYWALK_CAIRO(set_source_rgba)(to, c.red, c.green, c.blue, c.opacity); }
  void use(const Pen& pen) const {
    use(pen.colour);
    JAYWALK_CAIRO(set_line_width)(to, pen.width);
    JAYWALK_CAIRO(set_dash)(to, &pen.dash, pen.dash > 0.0 ? 1 : 0, 0.0);
  }
  void use(const Lettering& lettering) const {
    const auto weight = lettering.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL;
    JAYWALK_CAIRO(select_font_face)(to, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, weight);
    JAYWALK_CAIRO(set_font_size)(to, lettering.size);
    use(lettering.colour);
  }
};

Canvas::Canvas(int width, int height) : cairo_(std::make_unique<Cairo>(width, height)) {
  cairo_->use(colour(0xFFFFFF));
  JAYWALK_CAIRO(paint)(cairo_->to);
  JAYWALK_CAIRO(set_line_join)(cairo_->to, CAIRO_LINE_JOIN_ROUND);
  const std::unique_ptr<cairo_font_options_t, Release> options(JAYWALK_CAIRO(font_options_create)());
  JAYWALK_CAIRO(font_options_set_antialias)(options.get(), CAIRO_ANTIALIAS_GRAY);
  JAYWALK_CAIRO(font_options_set_hint_style)
  (options.get(), CAIRO_HINT_STYLE_NONE);  // the same on every screen and printer
  JAYWALK_CAIRO(font_options_set_hint_metrics)(options.get(), CAIRO_HINT_METRICS_OFF);
  JAYWALK_CAIRO(set_font_options)(cairo_->to, options.get());
}

Canvas::~Canvas() = default;

void Canvas::fill(const Polyline& outline, const Colour& colour) {
  cairo_->trace(outline);
  cairo_->use(colour);
  JAYWALK_CAIRO(fill)(cairo_->to);
}

void Canvas::stroke(const Polyline& line, const Pen& pen, bool closed) {
  cairo_->trace(line);
  if (closed) JAYWALK_CAIRO(close_path)(cairo_->to);
  cairo_->use(pen);
  JAYWALK_CAIRO(stroke)(cairo_->to);
}

void Canvas::fill_disc(Vec2 centre, double radius, const Colour& colour) {
  cairo_->trace_circle(centre, radius);
  cairo_->use(colour);
  JAYWALK_CAIRO(fill)(cairo_->to);
}

void Canvas::stroke_circle(Vec2 centre, double radius, const Pen& pen) {
  cairo_->trace_circle(centre, radius);
  cairo_->use(pen);
  JAYWALK_CAIRO(stroke)(cairo_->to);
}

void Canvas::write(Vec2 at, const std::string& text, const Lettering& lettering) {
  cairo_->use(lettering);
  cairo_text_extents_t extents;
  JAYWALK_CAIRO(text_extents)(cairo_->to, text.c_str(), &extents);
  const double share = lettering.align == Align::kLeft ? 0.0 : lettering.align == Align::kRight ? 1.0 : 0.5;
  JAYWALK_CAIRO(move_to)(cairo_->to, at.x - share * extents.x_advance, at.y);
  JAYWALK_CAIRO(show_text)(cairo_->to, text.c_str());
}

void Canvas::image(const std::vector<Colour>& pixels, int width, int height, Vec2 upper_left, Vec2 size) {
  const Surface picture = surface_of(pixels, width, height);
  JAYWALK_CAIRO(save)(cairo_->to);
  JAYWALK_CAIRO(translate)(cairo_->to, upper_left.x, upper_left.y);
  JAYWALK_CAIRO(scale)(cairo_->to, size.x / width, size.y / height);
  JAYWALK_CAIRO(set_source_surface)(cairo_->to, picture.get(), 0.0, 0.0);
  JAYWALK_CAIRO(pattern_set_filter)(JAYWALK_CAIRO(get_source)(cairo_->to), CAIRO_FILTER_BILINEAR);
  JAYWALK_CAIRO(paint)(cairo_->to);
  JAYWALK_CAIRO(restore)(cairo_->to);
}

void Canvas::clip(Vec2 upper_left, Vec2 size) {
  JAYWALK_CAIRO(save)(cairo_->to);
  JAYWALK_CAIRO(rectangle)(cairo_->to, upper_left.x, upper_left.y, size.x, size.y);
  JAYWALK_CAIRO(clip)(cairo_->to);
}

void Canvas::unclip() { JAYWALK_CAIRO(restore)(cairo_->to); }

void Canvas::save_png(const std::string& file) const {
  const cairo_status_t status = JAYWALK_CAIRO(surface_write_to_png)(cairo_->surface.get(), file.c_str());
  if (status != CAIRO_STATUS_SUCCESS) {
    std::remove(file.c_str());  // half a picture is none
    throw StartupError(file + ": " + JAYWALK_CAIRO(status_to_string)(status),
                       "choose an --out folder that may be written");
  }
}

}  // namespace jaywalk
