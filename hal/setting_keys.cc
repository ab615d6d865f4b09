#include "hal/setting_keys.h"

#include <cstdio>
#include <stdexcept>

namespace jaywalk {
namespace {

/// The shortest of two forms; 4000000 is no 4e+06.
std::string shortest(double value) {
  char text[40];
  std::snprintf(text, sizeof text, value < 1e9 ? "%.10g" : "%g", value);
  return text;
}

const SettingKey* look_up(const std::vector<SettingKey>& keys, const std::string& section, const std::string& key) {
  for (const SettingKey& row : keys)
    if (row.section == section && row.key == key) return &row;
  const std::size_t end = section.find(':');
  return end == std::string::npos ? nullptr : look_up(keys, section.substr(0, end), key);
}

}  // namespace

SettingKey key_row(const char* key, KeyKind kind, Otherwise otherwise, const char* meaning, const char* unit) {
  return {"", key, kind, {}, unit, otherwise, meaning};
}

SettingKey number_row(const char* key, Range range, const char* unit, Otherwise otherwise, const char* meaning) {
  return {"", key, KeyKind::kNumber, range, unit, otherwise, meaning};
}

SettingKey whole_row(const char* key, Range range, const char* unit, Otherwise otherwise, const char* meaning) {
  return {"", key, KeyKind::kInteger, range, unit, otherwise, meaning};
}

SettingKey choice_row(const char* key, Otherwise otherwise, const char* meaning,
                      const std::vector<std::string>& choices) {
  return {"", key, KeyKind::kChoice, {}, "", otherwise, meaning, choices};
}

SettingKey in_section(const std::string& section, SettingKey row) {
  row.section = section;
  return row;
}

std::vector<SettingKey> section_keys(const std::string& section, std::vector<SettingKey> rows) {
  for (SettingKey& row : rows) row.section = row.section.empty() ? section : row.section;
  return rows;
}

FileKeys file_keys(const char* title, const std::vector<std::vector<SettingKey>>& sections) {
  FileKeys file{title, {}};
  for (const auto& keys : sections) file.keys.insert(file.keys.end(), keys.begin(), keys.end());
  return file;
}

const SettingKey& FileKeys::find(const std::string& section, const std::string& key) const {
  const SettingKey* row = look_up(keys, section, key);
  if (row == nullptr) throw std::logic_error(std::string(title) + ": no key " + section + "." + key + " in its table");
  return *row;
}

bool FileKeys::has(const std::string& section, const std::string& key) const {
  return look_up(keys, section, key) != nullptr;
}

std::string FileKeys::choice_with(const std::string& section, const std::string& key) const {
  for (const SettingKey& row : keys)
    if (row.key == key && row.section.starts_with(section + ":")) return row.section.substr(section.size() + 1);
  return "";
}

std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

std::string allowed(const SettingKey& key) {
  switch (key.kind) {
    case KeyKind::kNumber: return shortest(key.range.low) + " to " + shortest(key.range.high);
    case KeyKind::kInteger: return shortest(key.range.low) + " to " + shortest(key.range.high) + ", whole";
    case KeyKind::kBoolean: return "true or false";
    case KeyKind::kChoice: return joined(key.choices);
    case KeyKind::kText: return "text";
    case KeyKind::kFile: return "path, relative to this file";
    case KeyKind::kNumbers: return "list of numbers";
    case KeyKind::kPoints: return "list of [x, y]";
    case KeyKind::kTexts: return "text, or a list of texts";
    case KeyKind::kTable: return "table";
    case KeyKind::kTables: return "tables";
  }
  return "";
}

std::string default_of(const SettingKey& key) {
  if (const auto* number = std::get_if<double>(&key.otherwise)) return shortest(*number);
  if (const auto* boolean = std::get_if<bool>(&key.otherwise)) return *boolean ? "true" : "false";
  if (const auto* words = std::get_if<const char*>(&key.otherwise)) return *words;
  return "needed";
}

}  // namespace jaywalk
