#pragma once
// Where recordings that are not the project's may lie.
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>

namespace jaywalk {

/// The recording's path in $JAYWALK_DATA, else beside the project; says "skipped: no data" and gives
/// nothing where it is missing.
inline std::optional<std::filesystem::path> recording(const std::filesystem::path& relative) {
  const char* folder = std::getenv("JAYWALK_DATA");
  const auto path = std::filesystem::path(folder != nullptr ? folder : JAYWALK_DATA_DEFAULT) / relative;
  if (std::filesystem::exists(path)) return path;
  std::cout << "skipped: no data (" << path.string() << ")\n";
  return std::nullopt;
}

}  // namespace jaywalk
