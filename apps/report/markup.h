#pragma once
#include <string>

namespace jaywalk {
/// The round length (1, 2 or 5 times a power of ten, 0.001 or more) next above `at_least`, for axes and scales.
inline double round_length(double at_least) {
  double decade = 0.001;
  while (decade * 10.0 <= at_least) decade *= 10.0;
  for (const double times : {1.0, 2.0, 5.0}) {
    if (decade * times >= at_least) return decade * times;
  }
  return decade * 10.0;
}

/// `text` as HTML and XML have it in texts and attributes.
inline std::string as_markup(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  }
  return out;
}

}  // namespace jaywalk
