#pragma once
#include <string>

namespace jaywalk {
/// A character as HTML and XML have it in texts and attributes.
inline std::string as_markup(char c) {
  switch (c) {
    case '&': return "&amp;";
    case '<': return "&lt;";
    case '>': return "&gt;";
    case '"': return "&quot;";
    default: return {c};
  }
}

inline std::string as_markup(const std::string& text) {
  std::string out;
  for (const char c : text) out += as_markup(c);
  return out;
}

}  // namespace jaywalk
