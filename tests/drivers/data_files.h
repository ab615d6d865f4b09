#pragma once
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <vector>

namespace jaywalk::tests {

/// A file of $JAYWALK_DATA, else of ../shared/data beside the project; empty, and "skipped: no data", where it is not.
inline std::filesystem::path data_file(const std::filesystem::path& relative) {
  const char* const from_user = std::getenv("JAYWALK_DATA");
  const auto path = std::filesystem::path(from_user != nullptr ? from_user : JAYWALK_DATA_DEFAULT) / relative;
  if (std::filesystem::exists(path)) return path;
  std::cout << "skipped: no data (" << path.string() << ")\n";
  return {};
}

inline std::vector<std::uint8_t> read_bytes(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace jaywalk::tests
