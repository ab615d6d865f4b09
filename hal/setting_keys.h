#pragma once
// The keys of the settings files: one table a kind of file, for its parser, `jaywalk config --explain` and the
// reference page; and settings given beside a file, "movers.count=16", in place of its own. Start-up only.
#include <filesystem>
#include <string>
#include <toml.hpp>
#include <variant>
#include <vector>

namespace jaywalk {

/// Closed interval of allowed numbers.
struct Range {
  double low = 0.0;
  double high = 0.0;
};

enum class KeyKind { kNumber, kInteger, kBoolean, kText, kChoice, kFile, kNumbers, kPoints, kTexts, kTable, kTables };

/// What holds where a key is absent: nothing (the key is needed), a value, or something that these words tell.
using Otherwise = std::variant<std::monostate, double, bool, const char*>;
inline constexpr std::monostate kNeeded{};

struct SettingKey {
  std::string section;  ///< "robot.laser"; "" at the top; "drive:vesc": of [drive] where its kind is vesc
  std::string key;
  KeyKind kind = KeyKind::kNumber;
  Range range{};          ///< of numbers and whole numbers
  const char* unit = "";  ///< "" for those that have none
  Otherwise otherwise{};
  const char* meaning = "";
  std::vector<std::string> choices{};  ///< of kChoice
};

// Rows; those without a section are for section_keys().

[[nodiscard]] inline SettingKey key_row(const char* key, KeyKind kind, Otherwise otherwise, const char* meaning,
                                        const char* unit = "") {
  return {"", key, kind, {}, unit, otherwise, meaning};
}
[[nodiscard]] inline SettingKey number_row(const char* key, Range range, const char* unit, Otherwise otherwise,
                                           const char* meaning) {
  return {"", key, KeyKind::kNumber, range, unit, otherwise, meaning};
}
[[nodiscard]] inline SettingKey whole_row(const char* key, Range range, const char* unit, Otherwise otherwise,
                                          const char* meaning) {
  return {"", key, KeyKind::kInteger, range, unit, otherwise, meaning};
}
[[nodiscard]] inline SettingKey choice_row(const char* key, Otherwise otherwise, const char* meaning,
                                           const std::vector<std::string>& choices) {
  return {"", key, KeyKind::kChoice, {}, "", otherwise, meaning, choices};
}
[[nodiscard]] inline SettingKey in_section(const std::string& section, SettingKey row) {
  row.section = section;
  return row;
}
/// Puts the rows that have no section into this one.
[[nodiscard]] inline std::vector<SettingKey> section_keys(const std::string& section, std::vector<SettingKey> rows) {
  for (SettingKey& row : rows) row.section = row.section.empty() ? section : row.section;
  return rows;
}

struct FileKeys {
  const char* title = "";  ///< "Scenario file"
  std::vector<SettingKey> keys;

  /// The key of `section`, or else of the section without its ":kind". Throws std::logic_error where there is none.
  [[nodiscard]] const SettingKey& find(const std::string& section, const std::string& key) const;
  [[nodiscard]] bool has(const std::string& section, const std::string& key) const;
  /// The choice of `section` ("vesc" of "drive:vesc") that has this key; empty where none has.
  [[nodiscard]] std::string choice_with(const std::string& section, const std::string& key) const {
    for (const SettingKey& row : keys)
      if (row.key == key && row.section.starts_with(section + ":")) return row.section.substr(section.size() + 1);
    return "";
  }
};

/// The keys of all sections, in their order.
[[nodiscard]] inline FileKeys file_keys(const char* title, const std::vector<std::vector<SettingKey>>& sections) {
  FileKeys file{title, {}};
  for (const auto& keys : sections) file.keys.insert(file.keys.end(), keys.begin(), keys.end());
  return file;
}

/// "0.1 to 100", "true or false", "p3dx, wheelchair": what may be written.
[[nodiscard]] std::string allowed(const SettingKey& key);
/// "needed", "0.3", "the model's".
[[nodiscard]] std::string default_of(const SettingKey& key);
/// "a, b, c"
[[nodiscard]] inline std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

/// What the place of a value begins with that no file holds.
inline constexpr const char* kGivenPlace = "--set ";

/// Puts `setting`, KEY=VALUE, into the parsed file `root`: KEY is a path of `keys`; VALUE is true, false, a number,
/// numbers with commas between them, or else a text. A key of tables written as [[movers]] is put into each of them
/// that may hold it; tables that are missing are made. A file's name is relative to the working folder. Throws
/// StartupError, but leaves range and kind of the value to the parser.
void apply_setting(toml::value& root, const FileKeys& keys, const std::filesystem::path& file,
                   const std::string& setting);

}  // namespace jaywalk
