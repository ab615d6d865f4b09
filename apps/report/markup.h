#pragma once
#include <string>

namespace jaywalk {

/// A character as HTML and XML have it in texts and attributes.
inline std::string as_markup(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    default:
      return {c};
  }
}

}  // namespace jaywalk
