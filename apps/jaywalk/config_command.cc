#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "apps/campaign/campaign.h"
#include "apps/jaywalk/commands.h"
#include "firmware/robot/robot_file.h"
#include "hal/robot_model_file.h"
#include "hal/shown_text.h"
#include "hal/sim/scenario.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

/// "drive.can", "timeout_s"; of a section "drive:vesc" as "drive.left_node".
std::string path_of(const SettingKey& key) {
  const std::string table = key.section.substr(0, key.section.find(':'));
  return table.empty() ? key.key : table + "." + key.key;
}

/// " (where kind is vesc)", or nothing.
std::string condition_of(const SettingKey& key) {
  const std::size_t colon = key.section.find(':');
  return colon == std::string::npos ? "" : " (where kind is " + key.section.substr(colon + 1) + ")";
}

/// The last name, the whole path, or its end.
bool names(const std::string& wanted, const SettingKey& key) {
  const std::string path = "." + path_of(key);
  return wanted.empty() || path.ends_with("." + wanted);
}

std::string with_unit(const std::string& text, const SettingKey& key) {
  return key.unit[0] == '\0' ? text : text + " " + key.unit;
}

std::string as_lines(const FileKeys& file, const std::string& wanted) {
  std::string lines;
  for (const SettingKey& key : file.keys)
    if (names(wanted, key))
      lines += "  " + path_of(key) + condition_of(key) + ": " + key.meaning + "\n      " +
               with_unit(allowed(key), key) + "; default: " + default_of(key) + "\n";
  return lines;
}

constexpr std::size_t kLongestLine = 156;  // of a Markdown file

/// What may be written, in the few words of a table.
std::string in_short(const SettingKey& key) {
  switch (key.kind) {
    case KeyKind::kNumber:
    case KeyKind::kInteger: {
      const std::string text = allowed(key);
      const std::size_t between = text.find(" to ");
      return with_unit(text.substr(0, between) + ".." + text.substr(between + 4), key);
    }
    case KeyKind::kBoolean: return "boolean";
    case KeyKind::kFile: return "path";
    case KeyKind::kNumbers:
    case KeyKind::kPoints: return key.unit[0] == '\0' ? "numbers" : key.unit;
    default: return allowed(key);
  }
}

/// Words one after the other, on lines of a bearable length.
std::string wrapped(std::string line, const std::vector<std::string>& words) {
  std::string lines;
  for (const std::string& word : words) {
    if (line.size() + word.size() > kLongestLine) {
      lines += line + "\n";
      line = "  ";
    } else if (line.back() == ',') {
      line += " ";
    }
    line += word + ",";
  }
  line.pop_back();
  return lines + line + "\n";
}

/// What the page says of a key beside its path and its default.
std::string content_of(const SettingKey& key) { return key.key + key.meaning + allowed(key) + key.unit; }

/// " (0.3)"; nothing of a key that is needed.
std::string in_brackets(const std::string& value) { return value == "needed" ? "" : " (" + value + ")"; }

/// A file's keys as rows without outer bars, which count as words. Kinds that have the same key share a row; keys with
/// the content of an earlier file's row are only named, by their default here.
class MarkdownTable {
 public:
  std::set<std::string> shown;  ///< contents of the rows

  void add(const SettingKey& key, const std::set<std::string>& shown_before) {
    const std::string path = "`" + path_of(key) + "`", content = content_of(key);
    if (shown_before.contains(content)) return repeated_[default_of(key)].push_back(path);
    shown.insert(content);
    if (key.kind == KeyKind::kTable || key.kind == KeyKind::kTables)
      return tables_.push_back(path + in_brackets(default_of(key)));
    const auto same = std::find_if(rows_.begin(), rows_.end(), [&](const Row& row) {
      return path_of(*row.key) + content_of(*row.key) + default_of(*row.key) ==
             path_of(key) + content + default_of(key);
    });
    Row& row = same == rows_.end() ? rows_.emplace_back(Row{&key, ""}) : *same;
    const std::size_t colon = key.section.find(':');
    if (colon != std::string::npos) row.kinds += (row.kinds.empty() ? "" : ", ") + key.section.substr(colon + 1);
  }
  [[nodiscard]] std::string text() const {
    std::string rows, lists;
    for (const Row& row : rows_) {
      std::string line = line_of(row, in_short(*row.key));
      if (line.size() > kLongestLine) {
        line = line_of(row, "below");
        lists += "\n" + wrapped("`" + path_of(*row.key) + "`: ", row.key->choices);
      }
      rows += line;
    }
    if (!tables_.empty()) lists += "\n" + wrapped("Tables: ", tables_);
    if (!rows.empty()) rows = "key | meaning: allowed (default)\n---|---\n" + rows + lists;
    if (!repeated_.empty()) rows += "\nAs in a file above, with the default:\n\n";
    for (const auto& [value, paths] : repeated_) rows += wrapped("- " + value + ": ", paths);
    return rows;
  }

 private:
  struct Row {
    const SettingKey* key;
    std::string kinds;  ///< that have it; empty: all
  };

  static std::string line_of(const Row& row, const std::string& may_be) {
    return "`" + path_of(*row.key) + "`" + (row.kinds.empty() ? "" : " (" + row.kinds + ")") + " | " +
           row.key->meaning + ": " + may_be + in_brackets(default_of(*row.key)) + "\n";
  }

  std::vector<Row> rows_;
  std::vector<std::string> tables_;                           ///< paths, with their defaults
  std::map<std::string, std::vector<std::string>> repeated_;  ///< paths by default
};

/// `shown_before`: the rows of earlier files.
std::string as_table(const FileKeys& file, const std::string& wanted, std::set<std::string>& shown_before) {
  MarkdownTable table;
  for (const SettingKey& key : file.keys)
    if (names(wanted, key)) table.add(key, shown_before);
  shown_before.merge(table.shown);
  return table.text();
}

constexpr const char* kSettingsHead = R"(# Settings files

Generated: `jaywalk config --explain --markdown >docs/reference/configuration.md`; a test compares the two.
`jaywalk config --explain KEY` prints a key's lines. An unknown key is refused with file and line. A key or table without a default
is needed where its table is. Brackets behind a key name the `kind` that has it. Paths are relative to the file.
)";

void explain(const std::string& wanted, bool markdown) {
  const std::array<const FileKeys*, 4> files{&robot_file_keys(), &robot_model_keys(), &sim::scenario_keys(),
                                             &campaign::campaign_keys()};
  std::string sections;
  std::set<std::string> shown_before;
  for (const FileKeys* file : files) {
    const std::string lines = markdown ? as_table(*file, wanted, shown_before) : as_lines(*file, wanted);
    if (lines.empty()) continue;
    sections += (markdown ? "\n## " + std::string(file->title) + "\n\n" : std::string(file->title) + "\n") + lines;
  }
  if (sections.empty())
    throw StartupError("--explain " + shown(wanted) + ": no file has such a key",
                       "see all of them with jaywalk config --explain");
  std::printf("%s%s", markdown ? kSettingsHead : "", sections.c_str());
}

}  // namespace

void add_config(CLI::App& app, int& /*exit_code*/) {
  static bool explains = false, markdown = false;
  static std::string key;
  CLI::App* config = app.add_subcommand("config", "Explain the keys of robot, model, scenario and campaign files");
  config->add_flag("--explain", explains, "Print keys with meaning, range, unit and default")->required();
  config->add_option("key", key, "One key, or the end of its path: rate_hz, laser.rate_hz (default: all)");
  config->add_flag("--markdown", markdown, "As the tables of docs/reference/configuration.md");
  config->callback([] { explain(key, markdown); });
}

}  // namespace jaywalk
