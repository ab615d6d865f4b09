#pragma once
// A text file, plain or gzip, a line at a time.
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

namespace jaywalk::sim {

/// Longest line that is read; a scan of 2,048 beams takes about 16 kB.
inline constexpr std::size_t kMaxLineBytes = 1U << 20U;

class TextLines {
 public:
  /// `expected` says what to give instead where there is no such file ("give the path of a recording"). Throws
  /// StartupError when the file cannot be read.
  TextLines(const std::filesystem::path& file, const std::string& expected);
  ~TextLines();

  /// Moves on to the next line; false at the end. Throws StartupError for a damaged or cut .gz and for a line that is
  /// too long.
  [[nodiscard]] bool next();
  /// The line without its end, be that "\n" or "\r\n"; valid until next().
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] std::size_t line() const { return line_; }
  [[nodiscard]] std::string name() const { return file_.string(); }
  /// Throws StartupError "FILE:LINE: cause; remedy" for the line at hand.
  [[noreturn]] void refuse(const std::string& cause, const std::string& remedy) const;

 private:
  struct Stream;

  std::filesystem::path file_;
  std::unique_ptr<Stream> stream_;
  std::string text_;
  std::size_t line_ = 0;
};

}  // namespace jaywalk::sim
