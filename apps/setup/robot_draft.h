#pragma once
// A ROBOT.toml in the making: keys with their values as TOML writes them, each with a comment.
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hal/toml_file.h"

namespace jaywalk {

class RobotDraft {
 public:
  /// `value` as TOML writes it; `note`: how it is known, "found" or "as answered", say. `section` without its ":kind";
  /// laser_section() for a scanner.
  void set(const std::string& section, const std::string& key, const std::string& value, const std::string& note) {
    values_[{section, key}] = {value, note};
  }
  [[nodiscard]] bool has(const std::string& section, const std::string& key) const {
    return values_.count({section, key}) != 0;
  }
  /// As set() wrote it; "" where it did not.
  [[nodiscard]] std::string value(const std::string& section, const std::string& key) const;
  /// A robot model file that is to lie beside it, under the name that its key `model` gives; empty: none.
  void set_model(const std::string& text) { model_ = text; }
  [[nodiscard]] const std::string& model() const { return model_; }
  /// Adds an entry to the array of tables [[section.key]]. `keys`: names and values, as TOML writes them.
  void add_table(const std::string& section, const std::string& key,
                 const std::vector<std::pair<std::string, std::string>>& keys);
  /// Adds a comment line to the top of the file, unless it is there already.
  void remark(const std::string& line) {
    if (std::ranges::find(remarks_, line) == remarks_.end()) remarks_.push_back(line);
  }

  /// The whole file, keys in the order of the table of keys, each with its meaning, unit and note.
  [[nodiscard]] std::string text() const;

 private:
  [[nodiscard]] bool has_section(const std::string& section) const {
    return std::ranges::any_of(values_, [&](const auto& each) { return each.first.first == section; });
  }
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

/// A text as TOML writes it, and a number.
[[nodiscard]] std::string literal(const std::string& text);
[[nodiscard]] std::string literal(double number);

// What a person knows of a robot: a file of answers with the keys of ROBOT.toml, and questions at a terminal.

class SetupAnswers {
 public:
  /// Complaint about a value as TOML writes it; empty: none.
  using Check = std::function<std::string(const std::string& value)>;

  /// `file` may be empty: no answers are given beforehand. A null terminal asks no questions. Both outlive it. What a
  /// person answers is kept in the file `kept` after each answer, and not asked again while that is there. Throws
  /// StartupError for a file that cannot be read, or with a key that ROBOT.toml does not know.
  SetupAnswers(const std::optional<std::filesystem::path>& file, std::istream* from, std::ostream* to,
               std::filesystem::path kept = {});

  /// The file's value, checked, as TOML writes it. Keys of one kind of drive are known once `take_kind` said which.
  [[nodiscard]] std::optional<std::string> given(const std::string& section, const std::string& key);
  /// The same as a text; "" where there is none.
  [[nodiscard]] std::string given_text(const std::string& section, const std::string& key) {
    return given(section, key) ? table(section)->text(key) : "";
  }
  [[nodiscard]] std::filesystem::path folder() const { return std::filesystem::path(name_).parent_path(); }
  [[nodiscard]] bool has_section(const std::string& section) const { return tables_.count(section) != 0; }
  /// How many scanners the file has, each in a section of its own by laser_section(); 0: none.
  [[nodiscard]] std::size_t scanners() const { return scanners_; }
  [[nodiscard]] bool asks() const { return from_ != nullptr; }
  void take_kind(const std::string& kind);

  /// Enters a value for the key: that of the answers file, else the operator's answer (the operator sees `suggestion`),
  /// else `suggestion` with `note`. Throws StartupError where none of the three gives a value.
  void settle(RobotDraft& draft, const std::string& section, const std::string& key, const std::string& suggestion = "",
              const std::string& note = "", const Check& check = {});
  void say(const std::string& found) const {
    if (asks()) *to_ << found << "\n";
  }
  /// What a person says of a key of any file, as TOML writes it.
  [[nodiscard]] std::string ask(const SettingKey& row, const std::string& section, const std::string& suggestion = "",
                                const Check& check = {});
  /// The person's choice among several, from 0; without a person, or with one to choose from, the first.
  [[nodiscard]] std::size_t choose(const std::string& what, const std::vector<std::string>& among);
  [[nodiscard]] bool agrees(const std::string& question);

  /// Enters what the file says besides, and refuses what it says that ROBOT.toml does not know.
  void finish(RobotDraft& draft) {
    for (auto& [section, table] : tables_) finish_section(draft, section, table);
  }

 private:
  TomlTable* table(const std::string& section);
  /// The row of a robot file's key, of the drives' kind where several have it.
  [[nodiscard]] const SettingKey& row_of(const std::string& section, const std::string& key) const;
  void finish_section(RobotDraft& draft, const std::string& section, TomlTable& table);
  void take_tables(RobotDraft& draft, TomlTable& parent, const std::string& section, const std::string& key);
  void refuse_unknown(const std::string& section, const toml::value& raw);
  [[nodiscard]] std::string line(const std::string& question);
  void keep(const std::string& question, const std::string& answer);

  std::string name_ = "--answers FILE";
  std::unique_ptr<TomlFile> file_;
  std::map<std::string, TomlTable> tables_;
  std::size_t scanners_ = 0;
  std::string kind_;  ///< of the drives; "" while it is not known
  std::istream* from_;
  std::ostream* to_;
  std::filesystem::path kept_;
  using Answer = std::pair<std::string, std::string>;  ///< question, answer
  std::vector<Answer> said_, earlier_;                 ///< in this session; left of one that was broken off
};

}  // namespace jaywalk
