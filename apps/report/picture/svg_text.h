#pragma once
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "apps/report/markup.h"
#include "apps/report/picture/canvas.h"
#include "apps/report/picture/map_frame.h"

namespace jaywalk::svg {

/// Nearest whole number, as text: whole units keep the file small.
inline std::string whole(double value) { return std::to_string(std::lround(value)); }

inline std::string pair(Vec2 p) { return whole(p.x) + " " + whole(p.y); }

/// `text` as XML's characters: '?' for each byte outside printable ASCII.
inline std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) out += c < ' ' || c > '~' ? "?" : as_markup(c);
  return out;
}

/// "#rrggbb"; opacity is left out.
inline std::string hex(const Colour& colour) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out = "#";
  for (const double part : {colour.red, colour.green, colour.blue}) {
    const auto byte = static_cast<unsigned>(std::lround(part * 255.0));
    out += kDigits[byte / 16U];
    out += kDigits[byte % 16U];
  }
  return out;
}

/// Values of an animation, separated by ';'.
template <class Values, class Word>
std::string joined(const Values& values, const Word& word) {
  std::string out;
  for (const auto& value : values) out += (out.empty() ? "" : ";") + word(value);
  return out;
}

/// A line through all points.
inline std::string path_of(const std::vector<Vec2>& points, const MapFrame& to_sheet) {
  std::string out;
  for (const Vec2 p : points) out += (out.empty() ? "M" : " ") + pair(to_sheet(p));
  return out;
}

}  // namespace jaywalk::svg
