#include <algorithm>
#include <charconv>

#include "hal/shown_text.h"
#include "hal/toml_file.h"

namespace jaywalk {
namespace {

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

bool is_any_empty(const std::vector<std::string>& values) {
  return values.empty() || std::any_of(values.begin(), values.end(), [](const std::string& v) { return v.empty(); });
}

}  // namespace

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
    if (is_any_empty(values))
      refuse(printable(key), "is neither text, number nor truth value, nor a list of them", "write one");
    all.push_back({before + key, values, place_of(key), line(key)});
  }
  return all;
}

}  // namespace jaywalk
