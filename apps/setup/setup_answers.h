#pragma once
// What a person knows of a robot: a file of answers with the keys of ROBOT.toml, and questions at a terminal.
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/setup/robot_draft.h"

namespace jaywalk {

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
  [[nodiscard]] std::string given_text(const std::string& section, const std::string& key);
  /// Folder of the file.
  [[nodiscard]] std::filesystem::path folder() const { return std::filesystem::path(name_).parent_path(); }
  [[nodiscard]] bool has_section(const std::string& section) const { return tables_.count(section) != 0; }
  /// How many scanners the file has, each in a section of its own by laser_section(); 0: none.
  [[nodiscard]] std::size_t scanners() const { return scanners_; }
  [[nodiscard]] bool asks() const { return from_ != nullptr; }
  void take_kind(const std::string& kind);

  /// Enters the key: as answered, else as a person says, who is shown `suggestion`, else as suggested with `note`.
  /// Throws StartupError where none of the three knows it.
  void settle(RobotDraft& draft, const std::string& section, const std::string& key, const std::string& suggestion = "",
              const std::string& note = "", const Check& check = {});
  /// Tells a person what was found.
  void say(const std::string& found) const;
  /// What a person says of a key of any file, as TOML writes it.
  [[nodiscard]] std::string said_of(const SettingKey& row) { return ask(row, row.section, ""); }
  /// The person's choice among several, from 0; without a person, or with one to choose from, the first.
  [[nodiscard]] std::size_t choose(const std::string& what, const std::vector<std::string>& among);
  [[nodiscard]] bool agrees(const std::string& question);

  /// Enters what the file says besides, and refuses what it says that ROBOT.toml does not know.
  void finish(RobotDraft& draft);

 private:
  TomlTable* table(const std::string& section);
  void finish_section(RobotDraft& draft, const std::string& section, TomlTable& table);
  void take_tables(RobotDraft& draft, TomlTable& parent, const std::string& section, const std::string& key);
  void refuse_unknown(const std::string& section, const toml::value& raw);
  [[nodiscard]] std::string ask(const SettingKey& row, const std::string& section, const std::string& suggestion,
                                const Check& check = {});
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
