#pragma once
// A file of bytes, read where a format says that something stands.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

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

// Compression formats of recordings.

/// `packed` in zstd's frames, lz4's frames or bzip2's, by the names that the formats give them: "zstd", "lz4", "bz2";
/// "" and "none" are not packed. `bytes`: how many come out, exactly. Nothing where they do not.
[[nodiscard]] std::optional<std::string> unpack(std::string_view method, std::string_view packed, std::size_t bytes);
/// Whether unpack() knows the method.
[[nodiscard]] bool can_unpack(std::string_view method);

/// zstd's frames that do not say how much comes out, at most `most` bytes.
[[nodiscard]] std::optional<std::string> unpack_zstd(std::string_view packed, std::size_t most);

/// One of zstd's frames, at its fastest usual level.
[[nodiscard]] std::string packed_zstd(std::string_view bytes);

}  // namespace jaywalk::exchange
