#include "apps/setup/robot_draft.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "firmware/robot/robot_file.h"

namespace jaywalk {
namespace {

constexpr std::size_t kWidest = 158;  // of a line

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

void RobotDraft::add_table(const std::string& section, const std::string& key,
                           const std::vector<std::pair<std::string, std::string>>& keys) {
  const std::string in = section.empty() ? "" : ".";
  std::string& block = tables_[section + in + key];
  block += "\n[[" + section_in_file(section) + in + key + "]]\n";
  for (const auto& [name, value] : keys) block.append(name).append(" = ").append(value).append("\n");
}

void RobotDraft::remark(const std::string& line) {
  if (std::ranges::find(remarks_, line) == remarks_.end()) remarks_.push_back(line);
}

bool RobotDraft::has_section(const std::string& section) const {
  return std::ranges::any_of(values_, [&](const auto& each) { return each.first.first == section; });
}

std::string RobotDraft::text_of(const std::string& section) const {
  if (!has_section(section)) return "";
  const std::string name = section_in_file(section), kind = value("drive", "kind");
  const bool is_listed = name == "laser" && has_section(laser_section(1));
  std::string text = section.empty() ? "" : is_listed ? "\n[[" + name + "]]\n" : "\n[" + name + "]\n";
  for (const SettingKey& row : robot_file_keys().keys) {
    const bool of_kind = row.section.starts_with(name + ":") && literal(row.section.substr(name.size() + 1)) == kind;
    const auto found = values_.find({section, row.key});
    if (found == values_.end() || (row.section != name && !of_kind)) continue;
    const std::string line = row.key + " = " + found->second.value;
    text += line + comment(row, found->second.note, line.size()) + "\n";
  }
  const auto blanked = tables_.find(section + ".blanked");
  return blanked == tables_.end() ? text : text + blanked->second;
}

std::string RobotDraft::text() const {
  std::string text;
  for (const std::string& line : remarks_) text += "# " + line + "\n";
  text += text_of("");
  for (std::size_t k = 0; has_section(laser_section(k)); ++k) text += text_of(laser_section(k));
  for (const char* section : {"drive", "panel", "realtime"}) text += text_of(section);
  const auto places = tables_.find("places");
  return places == tables_.end() ? text : text + places->second;
}

std::string laser_section(std::size_t scanner) {
  return scanner == 0 ? "laser" : "laser " + std::to_string(scanner + 1);
}

std::string section_in_file(const std::string& section) { return section.substr(0, section.find(' ')); }

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
    case KeyKind::kNumber: return literal(table.number(row.key));
    case KeyKind::kInteger: return std::to_string(table.integer(row.key));
    case KeyKind::kBoolean: return table.boolean(row.key, false) ? "true" : "false";
    case KeyKind::kChoice: return literal(row.choices[table.choice(row.key)]);
    case KeyKind::kNumbers: {
      std::string list;
      for (const double number : table.numbers(row.key, 2, 3)) list += (list.empty() ? "" : ", ") + literal(number);
      return "[" + list + "]";
    }
    default: return literal(table.text(row.key));
  }
}

const SettingKey& robot_key(const std::string& section, const std::string& key, const std::string& kind) {
  return robot_file_keys().find(kind.empty() ? section : section + ":" + kind, key);
}

}  // namespace jaywalk
