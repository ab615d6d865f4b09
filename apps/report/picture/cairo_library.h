#pragma once
// Cairo, found when a picture is first drawn: a robot's program starts without it, and without the X11 and font
// libraries that it brings.
#include <cairo.h>

/// The functions of cairo.h that a canvas calls, without their prefix.
#define JAYWALK_CAIRO_FUNCTIONS(X) \
  X(arc)                           \
  X(clip)                          \
  X(close_path)                    \
  X(create)                        \
  X(destroy)                       \
  X(fill)                          \
  X(font_options_create)           \
  X(font_options_destroy)          \
  X(font_options_set_antialias)    \
  X(font_options_set_hint_metrics) \
  X(font_options_set_hint_style)   \
  X(get_source)                    \
  X(image_surface_create)          \
  X(image_surface_get_data)        \
  X(image_surface_get_stride)      \
  X(line_to)                       \
  X(move_to)                       \
  X(new_path)                      \
  X(paint)                         \
  X(pattern_set_filter)            \
  X(rectangle)                     \
  X(restore)                       \
  X(save)                          \
  X(scale)                         \
  X(select_font_face)              \
  X(set_dash)                      \
  X(set_font_options)              \
  X(set_font_size)                 \
  X(set_line_join)                 \
  X(set_line_width)                \
  X(set_source_rgba)               \
  X(set_source_surface)            \
  X(show_text)                     \
  X(status)                        \
  X(status_to_string)              \
  X(stroke)                        \
  X(surface_destroy)               \
  X(surface_mark_dirty)            \
  X(surface_status)                \
  X(surface_write_to_png)          \
  X(text_extents)                  \
  X(translate)

namespace jaywalk {
/// Cairo's functions by address.
struct CairoLibrary {
#define JAYWALK_CAIRO_MEMBER(name) decltype(&::cairo_##name) name = nullptr;
  JAYWALK_CAIRO_FUNCTIONS(JAYWALK_CAIRO_MEMBER)
#undef JAYWALK_CAIRO_MEMBER
};

/// Loads the shared library of that name, for as long as the program runs. Null where it is not installed or lacks a
/// function. Not for the loop.
[[nodiscard]] const CairoLibrary* load_cairo(const char* name);

/// The same for libcairo.so.2, looked for once.
[[nodiscard]] const CairoLibrary* cairo_library();

}  // namespace jaywalk
