#pragma once
// Reading settings from TOML files in such a way that every mistake is refused with its place:
// "FILE:LINE: cause; remedy". Start-up only.
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <toml.hpp>
#include <vector>

namespace jaywalk {

/// Closed interval of allowed numbers.
struct Range {
  double low = 0.0;
  double high = 0.0;
};

/// One table of a file. Each key is asked for by name; `finish` refuses the keys that nobody asked for.
/// The table belongs to a TomlFile that outlives it.
class TomlTable {
 public:
  TomlTable(const std::filesystem::path& file, const toml::value& table, std::string name);

  [[nodiscard]] bool has(const std::string& key) const;
  /// The number under `key`; without a default the key must be there. Throws for a wrong type, NaN, or outside `range`.
  [[nodiscard]] double number(const std::string& key, Range range);
  [[nodiscard]] double number(const std::string& key, Range range, double otherwise);
  [[nodiscard]] std::int64_t integer(const std::string& key, Range range);
  [[nodiscard]] std::int64_t integer(const std::string& key, Range range, std::int64_t otherwise);
  [[nodiscard]] bool boolean(const std::string& key, bool otherwise);
  [[nodiscard]] std::string text(const std::string& key);
  [[nodiscard]] std::string text(const std::string& key, const std::string& otherwise);
  /// An array of exactly `count` finite numbers.
  [[nodiscard]] std::vector<double> numbers(const std::string& key, std::size_t count) {
    return numbers(key, count, count);
  }
  /// Of `least` or `most` of them.
  [[nodiscard]] std::vector<double> numbers(const std::string& key, std::size_t least, std::size_t most);
  /// A table that must be there.
  [[nodiscard]] TomlTable table(const std::string& key);
  /// The tables written as [[key]]; none when the key is absent.
  [[nodiscard]] std::vector<TomlTable> tables(const std::string& key);

  /// An existing file named under `key`, relative to this file's folder.
  [[nodiscard]] std::filesystem::path existing_file(const std::string& key);
  /// Throws for the first key, in the file's order, that was not asked for.
  void finish() const;
  /// "FILE:LINE: " of `key`, or of the table where the key is absent: how a complaint about it begins.
  [[nodiscard]] std::string place_of(const std::string& key) const;
  /// Throws StartupError at that place.
  [[noreturn]] void refuse(const std::string& key, const std::string& cause, const std::string& remedy) const;

 private:
  const toml::value* find(const std::string& key);
  const toml::value& need(const std::string& key);
  [[nodiscard]] std::string title(const std::string& key) const;
  [[nodiscard]] double number_from(const std::string& key, const toml::value& node, Range range) const;
  [[nodiscard]] std::int64_t integer_from(const std::string& key, const toml::value& node, Range range) const;

  const std::filesystem::path* file_;
  const toml::value* table_;
  std::string name_;
  std::set<std::string> asked_;
};

/// A parsed file. Throws StartupError when it cannot be read or is not TOML.
class TomlFile {
 public:
  explicit TomlFile(const std::filesystem::path& file);
  [[nodiscard]] TomlTable root() const { return {file_, table_, ""}; }

 private:
  std::filesystem::path file_;
  toml::value table_;
};

}  // namespace jaywalk
