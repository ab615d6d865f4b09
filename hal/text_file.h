#pragma once
#include <filesystem>
#include <fstream>
#include <string>

#include "hal/types/errors.h"

namespace jaywalk {

/// Throws StartupError where `path` is no regular file or may not be read, with `place` before the cause: folders and
/// pipes are none.
inline void require_readable(const std::filesystem::path& path, const std::string& place, const std::string& expected) {
  std::error_code unknown;
  const auto kind = std::filesystem::status(path, unknown).type();
  if (kind == std::filesystem::file_type::not_found) throw StartupError(place + "no such file", expected);
  if (kind == std::filesystem::file_type::directory) throw StartupError(place + "a folder", expected);
  if (kind != std::filesystem::file_type::regular) throw StartupError(place + "no regular file", expected);
  if (!std::ifstream(path)) throw StartupError(place + "cannot be read", "check its permissions");
}

/// Some editors and spreadsheets begin a text with three bytes that say "UTF-8".
inline void drop_byte_order_mark(std::string& first_line) {
  constexpr const char* kMark = "\xEF\xBB\xBF";
  if (first_line.rfind(kMark, 0) == 0) first_line.erase(0, 3);
}

}  // namespace jaywalk
