#pragma once
// A text file, plain or gzip, a line of words at a time.
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "apps/formats/logs/recorded_log.h"

namespace jaywalk::sim {

// A text file, plain or gzip, a line at a time.

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
  [[noreturn]] void refuse(const std::string& cause, const std::string& remedy) const {
    throw StartupError(name() + ":" + std::to_string(line_) + ": " + cause, remedy);
  }

 private:
  struct Stream;

  std::filesystem::path file_;
  std::unique_ptr<Stream> stream_;
  std::string text_;
  std::size_t line_ = 0;
};

/// Words are separated by spaces and tabs, or by commas where the line has one: then they may be empty. Lines that are
/// empty or begin with '#' are skipped.
class LineFile {
 public:
  /// Throws StartupError when the file cannot be read.
  explicit LineFile(const std::filesystem::path& file) : lines_(file, "give the path of a recording") {}

  /// Moves on to the next line with words in it; false at the end. Throws StartupError for a
  /// damaged or cut .gz and for a line that is too long.
  [[nodiscard]] bool next();
  /// The line's words; valid until next().
  [[nodiscard]] const std::vector<std::string_view>& words() const { return words_; }
  /// Word `i` as a number; "nan" and "inf" are numbers. Throws StartupError where it is none.
  [[nodiscard]] double number(std::size_t i) const;
  /// Word `i` as a count of at most `most`. Throws StartupError where it is none or larger.
  [[nodiscard]] std::size_t count(std::size_t i, std::size_t most) const;
  /// Word `i` as seconds that fit the time line. Throws StartupError where it is not.
  [[nodiscard]] double seconds(std::size_t i) const;

  [[nodiscard]] bool has_commas() const { return lines_.text().find(',') != std::string::npos; }
  [[nodiscard]] std::size_t line() const { return lines_.line(); }
  [[nodiscard]] std::string name() const { return lines_.name(); }
  [[nodiscard]] LogPlace place() const { return {name(), line()}; }
  /// Throws StartupError "FILE:LINE: cause; remedy" for the line at hand.
  [[noreturn]] void refuse(const std::string& cause, const std::string& remedy) const { lines_.refuse(cause, remedy); }

 private:
  void split();

  TextLines lines_;
  std::vector<std::string_view> words_;
};

}  // namespace jaywalk::sim
