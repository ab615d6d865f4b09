#include "apps/setup/robot_draft.h"

#include <array>
#include <cstdio>

#include "firmware/robot/robot_file_keys.h"

namespace jaywalk {
namespace {

constexpr std::size_t kWidest = 158;  // of a line

std::string base_of(const std::string& section) { return section.substr(0, section.find(':')); }

/// "  # meaning (unit); note", cut where the line would be too long.
std::string comment(const SettingKey& row, const std::string& note, std::size_t taken) {
  const std::string unit = row.unit[0] == '\0' ? "" : std::string(" (") + row.unit + ")";
  std::string text = std::string("  # ") + row.meaning + unit + (note.empty() ? "" : "; " + note);
  if (taken + text.size() > kWidest) text = "  # " + note;
  return text;
}

}  // namespace

void RobotDraft::set(const std::string& section, const std::string& key, const std::string& value,
                     const std::string& note) {
  values_[{section, key}] = {value, note};
}

bool RobotDraft::has(const std::string& section, const std::string& key) const {
  return values_.count({section, key}) != 0;
}

std::string RobotDraft::value(const std::string& section, const std::string& key) const {
  const auto found = values_.find({section, key});
  return found == values_.end() ? "" : found->second.value;
}

void RobotDraft::add_table(const std::string& name, const std::vector<std::pair<std::string, std::string>>& keys) {
  std::string& block = tables_[name];
  block += "\n[[" + name + "]]\n";
  for (const auto& [key, value] : keys) block.append(key).append(" = ").append(value).append("\n");
}

void RobotDraft::remark(const std::string& line) { remarks_.push_back(line); }

std::string RobotDraft::text() const {
  std::string text;
  for (const std::string& line : remarks_) text += "# " + line + "\n";
  std::string section;
  const auto chosen = values_.find({"drive", "kind"});
  const std::string kind = chosen == values_.end() ? "" : chosen->second.value;
  const auto end_section = [&] {
    if (const auto blanked = tables_.find(section + ".blanked"); blanked != tables_.end()) text += blanked->second;
  };
  for (const SettingKey& row : robot_file_keys().keys) {
    const std::string here = base_of(row.section);
    const auto found = values_.find({here, row.key});
    const bool of_other_kind = here != row.section && literal(row.section.substr(here.size() + 1)) != kind;
    if (found == values_.end() || of_other_kind) continue;
    if (here != section) {
      end_section();
      text += "\n[" + here + "]\n";
      section = here;
    }
    const std::string line = row.key + " = " + found->second.value;
    text += line + comment(row, found->second.note, line.size()) + "\n";
  }
  end_section();
  if (const auto places = tables_.find("places"); places != tables_.end()) text += places->second;
  return text;
}

std::string literal(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += (c == '"' || c == '\\') ? std::string("\\") + c : std::string(1, c);
  return quoted + "\"";
}

std::string literal(double number) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.10g", number);
  return text.data();
}

std::string literal_of(TomlTable& table, const SettingKey& row) {
  switch (row.kind) {
    case KeyKind::kNumber:
      return literal(table.number(row.key));
    case KeyKind::kInteger:
      return std::to_string(table.integer(row.key));
    case KeyKind::kBoolean:
      return table.boolean(row.key, false) ? "true" : "false";
    case KeyKind::kChoice:
      return literal(row.choices[table.choice(row.key)]);
    case KeyKind::kNumbers: {
      std::string list;
      for (const double number : table.numbers(row.key, 2, 3)) list += (list.empty() ? "" : ", ") + literal(number);
      return "[" + list + "]";
    }
    default:
      return literal(table.text(row.key));
  }
}

const SettingKey& robot_key(const std::string& section, const std::string& key, const std::string& kind) {
  return robot_file_keys().find(kind.empty() ? section : section + ":" + kind, key);
}

}  // namespace jaywalk
