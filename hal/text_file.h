#pragma once
#include <filesystem>
#include <fstream>
#include <iterator>
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

/// All of a file that must be there. Throws StartupError as require_readable() does, and where reading fails on the way
/// or the file is longer than any text of ours: the kernel has regular files that cannot be read, and endless ones.
inline std::string whole_text(const std::filesystem::path& path, const std::string& place,
                              const std::string& expected) {
  constexpr std::size_t kBlock = 1U << 16U, kMostBytes = 1U << 26U;
  require_readable(path, place, expected);
  std::ifstream in(path, std::ios::binary);
  std::string text, block(kBlock, '\0');
  do {
    in.read(block.data(), static_cast<std::streamsize>(kBlock));
    text.append(block, 0, static_cast<std::size_t>(in.gcount()));
  } while (in && text.size() <= kMostBytes);
  if (in.bad()) throw StartupError(place + "cannot be read to its end", expected);
  if (text.size() > kMostBytes) throw StartupError(place + "is longer than 64 MiB", expected);
  return text;
}

/// Some editors and spreadsheets begin a text with three bytes that say "UTF-8".
inline void drop_byte_order_mark(std::string& first_line) {
  constexpr const char* kMark = "\xEF\xBB\xBF";
  if (first_line.rfind(kMark, 0) == 0) first_line.erase(0, 3);
}

/// All of it; empty where it cannot be read.
inline std::string text_in(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Throws StartupError where `file` does not take all of it.
inline void write_text(const std::filesystem::path& file, const std::string& text, const std::string& remedy) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw StartupError(file.string() + ": cannot be written", remedy);
}

/// Throws StartupError about a line, counted from 1, of a table that `rows` tells how to write; 0: about the whole.
[[noreturn]] inline void refuse_line(const std::filesystem::path& file, int line, const std::string& cause,
                                     const std::string& rows) {
  throw StartupError(file.string() + (line > 0 ? ":" + std::to_string(line) : "") + ": " + cause, rows);
}

}  // namespace jaywalk
