#pragma once
// Texts that a test looks into, messages of refusals among them.
#include <string>

#include "hal/types/errors.h"

namespace jaywalk {

inline bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

inline std::size_t count_of(const std::string& part, const std::string& text) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

/// Message that `call` is refused with; empty where it is not.
template <class Call>
std::string refusal_of(const Call& call) {
  try {
    static_cast<void>(call());
  } catch (const StartupError& error) {
    return error.what();
  }
  return "";
}

}  // namespace jaywalk
