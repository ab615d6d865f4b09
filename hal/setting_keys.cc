#include "hal/setting_keys.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "hal/shown_text.h"
#include "hal/toml_file.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

/// The shortest of two forms; 4000000 is no 4e+06.
std::string shortest(double value) { return value < 1e9 ? formatted("%.10g", value) : formatted("%g", value); }

const SettingKey* look_up(const std::vector<SettingKey>& keys, const std::string& section, const std::string& key) {
  for (const SettingKey& row : keys)
    if (row.section == section && row.key == key) return &row;
  const std::size_t end = section.find(':');
  return end == std::string::npos ? nullptr : look_up(keys, section.substr(0, end), key);
}

/// "movers" of "movers:wander".
std::string table_of(const SettingKey& key) { return key.section.substr(0, key.section.find(':')); }

std::string path_of(const SettingKey& key) { return table_of(key).empty() ? key.key : table_of(key) + "." + key.key; }

bool spells_number(const std::string& word) {
  const auto value = number_in<double>(word);
  return value && std::isfinite(*value);
}

/// TOML wants digits on both sides of a point.
std::string number_in_toml(std::string word) {
  if (word.find_first_of(".eE") == std::string::npos) return word;
  const double value = number_in<double>(word).value_or(0.0);
  char digits[64];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  word.assign(digits, end);
  return word.find_first_of(".e") == std::string::npos ? word + ".0" : word;
}

std::vector<std::string> parts_of(const std::string& text, char between) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, between);) parts.push_back(part);
  return parts;
}

std::string in_toml(const SettingKey& key, const std::string& value) {
  if (value == "true" || value == "false") return value;
  if (spells_number(value)) return number_in_toml(value);
  const std::vector<std::string> parts = parts_of(value, ',');
  if (parts.size() > 1 && std::all_of(parts.begin(), parts.end(), spells_number)) {
    std::string list;
    for (const std::string& part : parts) list += (list.empty() ? "[" : ", ") + number_in_toml(part);
    return list + "]";
  }
  return "'" + (key.kind == KeyKind::kFile ? std::filesystem::absolute(value).string() : value) + "'";
}

/// The rows of `keys` that `path` names: one, or one for each kind of table.
std::vector<const SettingKey*> rows_of(const FileKeys& keys, const std::string& path, const std::string& place) {
  std::vector<const SettingKey*> rows;
  std::vector<std::string> known;
  for (const SettingKey& key : keys.keys) {
    const bool holds_others = key.kind == KeyKind::kTable || key.kind == KeyKind::kTables;
    if (!holds_others) known.push_back(path_of(key));
    if (!holds_others && path_of(key) == path) rows.push_back(&key);
  }
  if (rows.empty())
    throw StartupError(place + "is not a known key", did_you_mean(path, known, "see jaywalk config --explain"));
  return rows;
}

/// Whether `table` may hold one of `rows`: those of a kind are for tables that say that kind.
bool may_hold(const toml::value& table, const std::vector<const SettingKey*>& rows) {
  return std::any_of(rows.begin(), rows.end(), [&](const SettingKey* row) {
    const std::size_t colon = row->section.find(':');
    if (colon == std::string::npos) return true;
    return table.contains("kind") && table.at("kind").is_string() &&
           toml::get<std::string>(table.at("kind")) == row->section.substr(colon + 1);
  });
}

/// Puts `given`, a table with one way down to the value, into `into`. Returns how many values it put.
int merge(toml::value& into, const toml::value& given, const std::vector<const SettingKey*>& rows) {
  int put = 0;
  for (const auto& [key, value] : given.as_table()) {
    toml::value* const old = into.contains(key) ? &into.at(key) : nullptr;
    if (value.is_table() && old != nullptr && old->is_array()) {
      for (toml::value& table : old->as_array())
        if (table.is_table() && may_hold(table, rows)) put += merge(table, value, rows);
    } else if (value.is_table() && old != nullptr && old->is_table()) {
      put += merge(*old, value, rows);
    } else {
      into.as_table()[key] = value, ++put;
    }
  }
  return put;
}

toml::value parsed(const std::string& line, const std::string& setting) {
  std::istringstream text(line);
  try {
    return toml::parse(text, kGivenPlace + shown(setting));
  } catch (const std::exception&) {  // 007, say
    throw StartupError(kGivenPlace + shown(setting) + ": has no value that TOML knows",
                       "write true, false, a number or a name");
  }
}

bool is_list(const FileKeys& keys, const std::string& table) {
  return std::any_of(keys.keys.begin(), keys.keys.end(),
                     [&](const SettingKey& key) { return key.kind == KeyKind::kTables && path_of(key) == table; });
}

/// As a person would write it; "" for what is neither text nor number nor truth value.
std::string written(const toml::value& value) {
  if (value.is_string()) return toml::get<std::string>(value);
  if (value.is_boolean()) return value.as_boolean() ? "true" : "false";
  if (value.is_integer()) return std::to_string(value.as_integer());
  if (!value.is_floating()) return "";
  char digits[64];
  return {digits, std::to_chars(digits, digits + sizeof digits, value.as_floating()).ptr};
}

std::vector<std::string> written_values(const toml::value& value) {
  std::vector<std::string> values;
  if (!value.is_array()) return {written(value)};
  for (const toml::value& item : value.as_array()) values.push_back(written(item));
  return values;
}

}  // namespace

const SettingKey& FileKeys::find(const std::string& section, const std::string& key) const {
  const SettingKey* row = look_up(keys, section, key);
  if (row == nullptr) throw std::logic_error(std::string(title) + ": no key " + section + "." + key + " in its table");
  return *row;
}

bool FileKeys::has(const std::string& section, const std::string& key) const {
  return look_up(keys, section, key) != nullptr;
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

void apply_setting(toml::value& root, const FileKeys& keys, const std::filesystem::path& file,
                   const std::string& setting) {
  const std::string place = kGivenPlace + shown(setting) + ": ";
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == setting.size())
    throw StartupError(place + "is no KEY=VALUE", "write it like movers.count=16");
  if (setting.find('\'') != std::string::npos || setting != printable(setting))
    throw StartupError(place + "holds a quote or a control character", "write letters that can be printed");
  const std::string path = setting.substr(0, equals);
  const std::vector<const SettingKey*> rows = rows_of(keys, path, place);
  const toml::value given = parsed(path + " = " + in_toml(*rows.front(), setting.substr(equals + 1)) + "\n", setting);
  const std::string table = table_of(*rows.front());
  const bool none = is_list(keys, table) && !root.contains(table);
  if (none || merge(root, given, rows) == 0)
    throw StartupError(place + file.string() + " has no [[" + table + "]] that may hold it", "choose another scenario");
}

std::vector<std::string> TomlTable::texts(const std::string& key) {
  const std::string remedy = "write a text in quotes, or a list of them";
  const toml::value& node = need(key);
  std::vector<std::string> all;
  if (node.is_string()) all.push_back(toml::get<std::string>(node));
  if (node.is_array()) {
    for (const toml::value& item : node.as_array()) {
      if (!item.is_string()) refuse(key, "holds what is no text", remedy);
      all.push_back(toml::get<std::string>(item));
    }
  }
  if (all.empty()) refuse(key, "is no text", remedy);
  for (const std::string& text : all)
    if (text.empty() || text != printable(text)) refuse(key, "holds an empty text or a control character", remedy);
  return all;
}

std::vector<Vec2> TomlTable::points_in_map(const std::string& key, std::size_t least, std::size_t most) {
  const toml::value& node = need(key);
  const std::string remedy = "write [[x, y], [x, y], ...]: " + std::to_string(least) + " to " + std::to_string(most);
  if (!node.is_array()) refuse(key, "is not an array", remedy);
  const toml::array& array = node.as_array();
  if (array.size() < least || array.size() > most)
    refuse(key, "has " + std::to_string(array.size()) + " points", remedy);
  std::vector<Vec2> points;
  for (const toml::value& item : array) {
    const std::vector<double> p = numbers_from(key, item, 2, 2);
    require_in_map(key, p);
    points.push_back({p[0], p[1]});
  }
  return points;
}

std::vector<ListedKey> TomlTable::listed(const std::string& key) {
  if (find(key) == nullptr) return {};
  std::vector<ListedKey> all = table(key).all_listed("");
  std::stable_sort(all.begin(), all.end(), [](const ListedKey& a, const ListedKey& b) {
    return a.line != b.line ? a.line < b.line : a.name < b.name;
  });
  return all;
}

std::vector<ListedKey> TomlTable::all_listed(const std::string& before) const {
  std::vector<ListedKey> all;
  for (const auto& [key, value] : table_->as_table()) {  // in no order
    if (value.is_table()) {
      const TomlTable inner(*file_, *keys_, value, title(key));
      for (ListedKey& listed : inner.all_listed(before + key + ".")) all.push_back(std::move(listed));
      continue;
    }
    const std::vector<std::string> values = written_values(value);
    if (values.empty() || std::find(values.begin(), values.end(), "") != values.end())
      refuse(printable(key), "is neither text, number nor truth value, nor a list of them", "write one");
    all.push_back({before + key, values, place_of(key), line(key)});
  }
  return all;
}

}  // namespace jaywalk
