#include "hal/toml_file.h"

#include <cmath>
#include <sstream>

#include "hal/types/errors.h"

namespace jaywalk {
namespace {

std::string place(const std::filesystem::path& file, const toml::source_region& where) {
  return file.string() + ":" + std::to_string(where.begin.line) + ": ";
}

std::string written(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

toml::table parse(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) {
    throw StartupError(file.string() + ":0: no such file", "give the path of a TOML file");
  }
  try {
    return toml::parse_file(file.string());
  } catch (const toml::parse_error& e) {
    throw StartupError(place(file, e.source()) + std::string(e.description()), "write valid TOML");
  }
}

}  // namespace

TomlFile::TomlFile(const std::filesystem::path& file) : file_(file), table_(parse(file)) {}

TomlTable::TomlTable(const std::filesystem::path& file, const toml::table& table, std::string name)
    : file_(&file), table_(&table), name_(std::move(name)) {}

std::string TomlTable::title(const std::string& key) const { return name_.empty() ? key : name_ + "." + key; }

void TomlTable::refuse(const std::string& key, const std::string& cause, const std::string& remedy) const {
  const toml::node* node = table_->get(key);
  const toml::source_region& where = node != nullptr ? node->source() : table_->source();
  throw StartupError(place(*file_, where) + title(key) + " " + cause, remedy);
}

const toml::node* TomlTable::find(const std::string& key) {
  asked_.insert(key);
  return table_->get(key);
}

const toml::node& TomlTable::need(const std::string& key) {
  const toml::node* node = find(key);
  if (node == nullptr) refuse(key, "is missing", "add it");
  return *node;
}

bool TomlTable::has(const std::string& key) const { return table_->get(key) != nullptr; }

double TomlTable::number_from(const std::string& key, const toml::node& node, Range range) const {
  if (!node.is_number()) refuse(key, "is not a number", "write a number");
  const double value = *node.value<double>();
  if (!(value >= range.low && value <= range.high)) {
    refuse(key, "is " + written(value), "choose a value from " + written(range.low) + " to " + written(range.high));
  }
  return value;
}

double TomlTable::number(const std::string& key, Range range) { return number_from(key, need(key), range); }

double TomlTable::number(const std::string& key, Range range, double otherwise) {
  const toml::node* node = find(key);
  return node == nullptr ? otherwise : number_from(key, *node, range);
}

std::int64_t TomlTable::integer_from(const std::string& key, const toml::node& node, Range range) const {
  if (!node.is_integer()) refuse(key, "is not a whole number", "write a whole number");
  static_cast<void>(number_from(key, node, range));  // refuses what is outside
  return *node.value<std::int64_t>();
}

std::int64_t TomlTable::integer(const std::string& key, Range range) { return integer_from(key, need(key), range); }

std::int64_t TomlTable::integer(const std::string& key, Range range, std::int64_t otherwise) {
  const toml::node* node = find(key);
  return node == nullptr ? otherwise : integer_from(key, *node, range);
}

bool TomlTable::boolean(const std::string& key, bool otherwise) {
  const toml::node* node = find(key);
  if (node == nullptr) return otherwise;
  if (!node->is_boolean()) refuse(key, "is not true or false", "write true or false");
  return *node->value<bool>();
}

std::string TomlTable::text(const std::string& key) {
  const toml::node& node = need(key);
  if (!node.is_string()) refuse(key, "is not a text", "write it in quotes");
  return *node.value<std::string>();
}

std::string TomlTable::text(const std::string& key, const std::string& otherwise) {
  return find(key) == nullptr ? otherwise : text(key);
}

std::vector<double> TomlTable::numbers(const std::string& key, std::size_t count) {
  const toml::array* array = need(key).as_array();
  const std::string remedy = "write [ ] with " + std::to_string(count) + " numbers";
  if (array == nullptr) refuse(key, "is not an array", remedy);
  if (array->size() != count) refuse(key, "has " + std::to_string(array->size()) + " elements", remedy);
  std::vector<double> values;
  for (const toml::node& node : *array) {
    if (!node.is_number() || !std::isfinite(*node.value<double>())) refuse(key, "holds what is no number", remedy);
    values.push_back(*node.value<double>());
  }
  return values;
}

TomlTable TomlTable::table(const std::string& key) {
  const toml::table* found = need(key).as_table();
  if (found == nullptr) refuse(key, "is not a table", "write [" + title(key) + "] and its keys below");
  return {*file_, *found, title(key)};
}

std::vector<TomlTable> TomlTable::tables(const std::string& key) {
  std::vector<TomlTable> found;
  const toml::node* node = find(key);
  if (node == nullptr) return found;
  const std::string remedy = "write [[" + title(key) + "]] and its keys below";
  if (!node->is_array()) refuse(key, "is not a list of tables", remedy);
  for (const toml::node& item : *node->as_array()) {
    if (!item.is_table()) refuse(key, "is not a list of tables", remedy);
    found.emplace_back(*file_, *item.as_table(), title(key));
  }
  return found;
}

std::filesystem::path TomlTable::existing_file(const std::string& key) {
  const std::filesystem::path named = text(key);
  const std::filesystem::path file = named.is_absolute() ? named : file_->parent_path() / named;
  if (!std::filesystem::is_regular_file(file)) {
    refuse(key, "names " + file.string() + ", which is no file", "give a path relative to this file's folder");
  }
  return file;
}

void TomlTable::finish() const {
  const toml::node* first = nullptr;
  std::string unknown;
  for (auto&& [key, node] : *table_) {
    const std::string name{std::string_view{key}};
    const bool earlier = first == nullptr || node.source().begin.line < first->source().begin.line;
    if (asked_.count(name) == 0 && earlier) first = &node, unknown = name;
  }
  if (first != nullptr) refuse(unknown, "is not a known key", "remove it or correct its spelling");
}

}  // namespace jaywalk
