#pragma once
// A file that only grows, and what happens to it when the disk is full.
#include <cstddef>
#include <span>
#include <string>

namespace jaywalk {

/// Appends bytes without a buffer of its own. After the first failure it takes no more: what stands before it is then
/// the file, without a gap. Only the constructor allocates. Thread: one.
class AppendFile {
 public:
  /// Makes the file, or empties it. Throws StartupError where it cannot.
  explicit AppendFile(const std::string& file);
  ~AppendFile();
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  /// How many of the bytes the disk took: all of them, or fewer and has_failed() from then on.
  [[nodiscard]] std::size_t append(std::span<const unsigned char> bytes) noexcept;
  /// Takes the last `bytes` back: a row or an entry of which the disk took a part.
  void take_back(std::size_t bytes) noexcept;
  /// False when the disk lost anything, now or before.
  bool close() noexcept;

  [[nodiscard]] bool has_failed() const noexcept { return error_ != 0; }
  [[nodiscard]] std::size_t bytes() const noexcept { return size_; }
  /// "out/robot.csv: the disk takes no more of it: No space left on device"; empty while all is well. Allocates.
  [[nodiscard]] std::string complaint() const;

 private:
  std::string file_;
  int descriptor_;
  std::size_t size_ = 0;
  int error_ = 0;  ///< errno of the first failure
};

}  // namespace jaywalk
