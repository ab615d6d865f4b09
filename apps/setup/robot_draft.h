#pragma once
// A ROBOT.toml in the making: keys with their values as TOML writes them, each with a comment.
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hal/toml_file.h"

namespace jaywalk {

class RobotDraft {
 public:
  /// `value` as TOML writes it; `note`: how it is known, "found" or "as answered", say. `section` without its ":kind";
  /// laser_section() for a scanner.
  void set(const std::string& section, const std::string& key, const std::string& value, const std::string& note);
  [[nodiscard]] bool has(const std::string& section, const std::string& key) const;
  /// As set() wrote it; "" where it did not.
  [[nodiscard]] std::string value(const std::string& section, const std::string& key) const;
  /// A robot model file that is to lie beside it, under the name that its key `model` gives; empty: none.
  void set_model(const std::string& text) { model_ = text; }
  [[nodiscard]] const std::string& model() const { return model_; }
  /// Adds an entry to the array of tables [[section.key]]. `keys`: names and values, as TOML writes them.
  void add_table(const std::string& section, const std::string& key,
                 const std::vector<std::pair<std::string, std::string>>& keys);
  /// Adds a comment line to the top of the file, unless it is there already.
  void remark(const std::string& line);

  /// The whole file, keys in the order of the table of keys, each with its meaning, unit and note.
  [[nodiscard]] std::string text() const;

 private:
  [[nodiscard]] bool has_section(const std::string& section) const;
  [[nodiscard]] std::string text_of(const std::string& section) const;

  struct Value {
    std::string value, note;
  };
  std::map<std::pair<std::string, std::string>, Value> values_;
  std::map<std::string, std::string> tables_;  ///< whole blocks, by name
  std::vector<std::string> remarks_;
  std::string model_;
};

/// The name of a scanner's section in a draft; `scanner` counts from 0: "laser", "laser 2" and so on.
[[nodiscard]] std::string laser_section(std::size_t scanner);
/// The name that such a section has in the file: "laser" for "laser 2".
[[nodiscard]] std::string section_in_file(const std::string& section);

/// What stands under the row's key, checked by the row, as TOML writes it. The key is there. Throws StartupError.
[[nodiscard]] std::string literal_of(TomlTable& table, const SettingKey& row);

/// A text as TOML writes it, and a number.
[[nodiscard]] std::string literal(const std::string& text);
[[nodiscard]] std::string literal(double number);

/// The row of a robot file's key, whatever its kind; `kind` decides where several have it.
[[nodiscard]] const SettingKey& robot_key(const std::string& section, const std::string& key,
                                          const std::string& kind = "");

}  // namespace jaywalk
