#pragma once
// A file of bytes, read where a format says that something stands.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace jaywalk::exchange {

/// Most bytes of one record, packed or not: a file that asks for more is damaged.
inline constexpr std::uint64_t kMostRecordBytes = 1U << 30U;

class ByteFile {
 public:
  /// `remedy`: what a person is told to do where it is damaged. Throws StartupError where it cannot be read.
  ByteFile(const std::filesystem::path& file, std::string remedy);

  /// Throws StartupError where the file ends before, or more than kMostRecordBytes are asked for.
  [[nodiscard]] std::string read(std::uint64_t at, std::uint64_t bytes);
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Throws StartupError "FILE: byte N: cause; remedy".
  [[noreturn]] void refuse(std::uint64_t at, const std::string& cause) const;
  [[nodiscard]] std::string name() const { return file_.string(); }

 private:
  std::filesystem::path file_;
  std::string remedy_;
  std::ifstream in_;
  std::uint64_t size_ = 0;
};

}  // namespace jaywalk::exchange
