#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/formats/logs/recorded_log.h"
#include "hal/text_file.h"

namespace jaywalk::sim {

/// A text file, plain or gzip, a line at a time.
class TextLines {
 public:
  /// `expected` says what to give instead where there is no such file ("give the path of a recording"). Throws
  /// StartupError when the file cannot be read.
  TextLines(const std::filesystem::path& file, const std::string& expected);

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
  std::filesystem::path file_;
  std::optional<GzipFile> stream_;
  std::string block_;      ///< read last
  std::size_t taken_ = 0;  ///< bytes of it
  std::string text_;
  std::size_t line_ = 0;
};

/// Words are separated by spaces and tabs, or by commas where the line has one: then they may be empty. Lines that are
/// empty or begin with '#' are skipped.
class LineFile : public TextLines {
 public:
  explicit LineFile(const std::filesystem::path& file) : TextLines(file, "give the path of a recording") {}

  /// TextLines::next() to the next line with words in it.
  [[nodiscard]] bool next();
  /// The line's words; valid until next().
  [[nodiscard]] const std::vector<std::string_view>& words() const { return words_; }
  /// Word `i` as a number; "nan" and "inf" are numbers. Throws StartupError where it is none.
  [[nodiscard]] double number(std::size_t i) const;
  /// Word `i` as a count of at most `most`. Throws StartupError where it is none or larger.
  [[nodiscard]] std::size_t count(std::size_t i, std::size_t most) const;
  /// Word `i` as seconds that fit the time line. Throws StartupError where it is not.
  [[nodiscard]] double seconds(std::size_t i) const;

  [[nodiscard]] bool has_commas() const { return text().find(',') != std::string::npos; }
  [[nodiscard]] LogPlace place() const { return {name(), line()}; }

 private:
  void split();

  std::vector<std::string_view> words_;
};

}  // namespace jaywalk::sim
