#pragma once
// Settings from TOML files; every mistake is refused with its place, "FILE:LINE: cause; remedy". Start-up only.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hal/setting_keys.h"
#include "hal/types/geometry.h"

namespace jaywalk {

/// A key of a table whose keys no table of keys has: those of another file.
struct ListedKey {
  std::string name;                 ///< "movers.count"
  std::vector<std::string> values;  ///< one, or those of its list
  std::string place;                ///< "FILE:LINE: "
  std::size_t line = 0;
};

/// One table of a file. Each key is asked for by name; `finish` refuses the keys that nobody asked for. Ranges and
/// defaults are those of the file's table of keys. The table belongs to a TomlFile that outlives it.
class TomlTable {
 public:
  TomlTable(const std::filesystem::path& file, const FileKeys& keys, const toml::value& table, std::string name)
      : file_(&file), keys_(&keys), table_(&table), name_(std::move(name)), section_(name_) {}

  [[nodiscard]] bool has(const std::string& key) const {
    static_cast<void>(row(key));
    return table_->contains(key);
  }
  /// Whether the key has no default.
  [[nodiscard]] bool needs(const std::string& key) const {
    return std::holds_alternative<std::monostate>(row(key).otherwise);
  }
  /// The number under `key`, else `otherwise`, else the default of the table of keys; where that has none the key must
  /// be there. Throws for a wrong type, NaN, outside the key's range, or more than `most`.
  [[nodiscard]] double number(const std::string& key, std::optional<double> otherwise = {},
                              double most = std::numeric_limits<double>::infinity()) {
    const toml::value* node = find_number(key, otherwise);
    const Range range = row(key).range;
    return node == nullptr ? *otherwise : number_from(key, *node, {range.low, std::min(range.high, most)});
  }
  [[nodiscard]] std::int64_t integer(const std::string& key, std::optional<std::int64_t> otherwise = {});
  [[nodiscard]] bool boolean(const std::string& key, std::optional<bool> otherwise = {});
  [[nodiscard]] std::string text(const std::string& key);
  [[nodiscard]] std::string text(const std::string& key, const std::string& otherwise) {
    return find(key) == nullptr ? otherwise : text(key);
  }
  /// Which of the key's choices it is, counted from 0.
  [[nodiscard]] std::size_t choice(const std::string& key);
  /// The same; what else is read are this choice's own keys ("drive:vesc") and the table's.
  [[nodiscard]] std::size_t choose_keys(const std::string& key) {
    const std::size_t chosen = choice(key);
    section_ = name_ + ":" + row(key).choices[chosen];
    return chosen;
  }
  /// What else is read are the keys of that choice, which is known from elsewhere.
  void take_keys_of(const std::string& choice) { section_ = name_ + ":" + choice; }
  /// An array of exactly `count` finite numbers.
  [[nodiscard]] std::vector<double> numbers(const std::string& key, std::size_t count) {
    return numbers(key, count, count);
  }
  /// Of `least` or `most` of them.
  [[nodiscard]] std::vector<double> numbers(const std::string& key, std::size_t least, std::size_t most) {
    return numbers_from(key, need(key), least, most);
  }
  /// One text, or a list of at least one.
  [[nodiscard]] std::vector<std::string> texts(const std::string& key);
  /// All keys of the table under `key`, in the file's order; none where there is no such table.
  [[nodiscard]] std::vector<ListedKey> listed(const std::string& key);
  /// A place in the map: [x, y] or [x, y, heading], within 100 km and one turn to either side; of `least` to 3 numbers.
  [[nodiscard]] std::vector<double> place_in_map(const std::string& key, std::size_t least);
  /// A list of `least` to `most` places [x, y] in the map, each within 100 km.
  [[nodiscard]] std::vector<Vec2> points_in_map(const std::string& key, std::size_t least, std::size_t most);
  /// A table that must be there.
  [[nodiscard]] TomlTable table(const std::string& key) {
    const toml::value& found = need(key);
    if (!found.is_table()) refuse(key, "is not a table", "write [" + title(key) + "] and its keys below");
    return {*file_, *keys_, found, title(key)};
  }
  /// One table that must be there, or several of them written as [[key]].
  [[nodiscard]] std::vector<TomlTable> table_or_tables(const std::string& key) {
    if (!need(key).is_array()) return {table(key)};
    std::vector<TomlTable> found = tables(key);
    if (found.empty()) refuse(key, "is an empty list", "write [" + title(key) + "] and its keys below");
    return found;
  }
  /// The tables written as [[key]]; none when the key is absent.
  [[nodiscard]] std::vector<TomlTable> tables(const std::string& key);

  /// An existing file named under `key`, relative to this file's folder; `remedy` for where there is none.
  [[nodiscard]] std::filesystem::path existing_file(const std::string& key, const std::string& remedy =
                                                                                "give a path relative to this file's "
                                                                                "folder");
  /// Throws for the first key, in the file's order, that was not asked for.
  void finish() const;
  /// "FILE:LINE: " of `key`, or of the table where the key is absent: how a complaint about it begins.
  [[nodiscard]] std::string place_of(const std::string& key) const;
  /// Refuses the whole file where it has `key`, which files of another kind have.
  void refuse_other_file(const std::string& key, const std::string& cause, const std::string& remedy) const {
    if (table_->contains(key)) refuse(key, cause, remedy);
  }
  /// Throws StartupError at that place.
  [[noreturn]] void refuse(const std::string& key, const std::string& cause, const std::string& remedy) const;

 private:
  const SettingKey& row(const std::string& key) const { return keys_->find(section_, key); }
  const toml::value* find(const std::string& key);
  const toml::value& need(const std::string& key);
  /// Throws where a key of the table that the file does not know looks like `key`.
  void refuse_misspelt(const std::string& key) const;
  /// As `find`, but a number must be there where it has no default, neither `otherwise` nor one of its own, which then
  /// becomes `otherwise`.
  template <class Number>
  const toml::value* find_number(const std::string& key, std::optional<Number>& otherwise) {
    const auto* own = std::get_if<double>(&row(key).otherwise);
    if (own != nullptr && !otherwise) otherwise = static_cast<Number>(*own);
    return needs(key) || !otherwise ? &need(key) : find(key);
  }
  [[nodiscard]] std::string title(const std::string& key) const { return name_.empty() ? key : name_ + "." + key; }
  [[nodiscard]] std::size_t line(const std::string& key) const;
  [[nodiscard]] std::vector<ListedKey> all_listed(const std::string& before) const;
  [[nodiscard]] double number_from(const std::string& key, const toml::value& node, Range range) const;
  [[nodiscard]] std::vector<double> numbers_from(const std::string& key, const toml::value& node, std::size_t least,
                                                 std::size_t most) const;
  void require_in_map(const std::string& key, const std::vector<double>& values) const;

  const std::filesystem::path* file_;
  const FileKeys* keys_;
  const toml::value* table_;
  std::string name_;
  std::string section_;  ///< the name, and ":kind" where keys hold for one kind only
  std::set<std::string> asked_;
};

/// A row of a table of keys and the member of a `T` that it sets, whose own value is the default; or a row alone.
template <class T>
struct BoundKey {
  BoundKey(SettingKey alone) : row(std::move(alone)) {}
  template <class Read>
  BoundKey(SettingKey bound, const Read& reader) : row(std::move(bound)), read(reader) {}

  SettingKey row;
  std::function<void(TomlTable&, T&)> read = [](TomlTable&, T&) {};
};

template <class T>
BoundKey<T> number_row(const char* key, double T::*member, Range range, const char* unit, const char* meaning) {
  return {number_row(key, range, unit, T{}.*member, meaning),
          [=](TomlTable& table, T& into) { into.*member = table.number(key, into.*member); }};
}
/// The same of a member that stays empty where the key is absent; `otherwise` tells what then holds.
template <class T>
BoundKey<T> number_row(const char* key, std::optional<double> T::*member, Range range, const char* unit,
                       const char* otherwise, const char* meaning) {
  return {number_row(key, range, unit, otherwise, meaning), [=](TomlTable& table, T& into) {
            if (table.has(key)) into.*member = table.number(key);
          }};
}
template <class T, class Whole>
BoundKey<T> whole_row(const char* key, Whole T::*member, Range range, const char* unit, const char* meaning) {
  return {whole_row(key, range, unit, static_cast<double>(T{}.*member), meaning), [=](TomlTable& table, T& into) {
            into.*member = static_cast<Whole>(table.integer(key, static_cast<std::int64_t>(into.*member)));
          }};
}
template <class T>
BoundKey<T> boolean_row(const char* key, bool T::*member, const char* meaning) {
  return {key_row(key, KeyKind::kBoolean, T{}.*member, meaning),
          [=](TomlTable& table, T& into) { into.*member = table.boolean(key, into.*member); }};
}

/// The same row with another default; kNeeded: it must be there.
template <class T>
BoundKey<T> with_default(BoundKey<T> bound, const Otherwise& otherwise) {
  bound.row.otherwise = otherwise;
  return bound;
}

/// The rows of one section and how they are read into a `T`.
template <class T>
class BoundKeys {
 public:
  /// `otherwise`: holds for all, in place of the members' own values.
  BoundKeys(std::string section, std::vector<BoundKey<T>> rows, const std::optional<Otherwise>& otherwise = {})
      : section_(std::move(section)), rows_(std::move(rows)) {
    for (BoundKey<T>& bound : rows_) bound.row.otherwise = otherwise.value_or(bound.row.otherwise);
  }
  [[nodiscard]] std::vector<SettingKey> keys() const {
    std::vector<SettingKey> rows;
    for (const BoundKey<T>& bound : rows_) rows.push_back(bound.row);
    return section_keys(section_, std::move(rows));
  }
  /// Reads the bound keys; the others are the caller's.
  void read(TomlTable& table, T& into) const {
    for (const BoundKey<T>& bound : rows_) bound.read(table, into);
  }
  /// Reads a whole table.
  [[nodiscard]] T read(TomlTable table) const {
    T value{};
    read(table, value);
    table.finish();
    return value;
  }

 private:
  std::string section_;
  std::vector<BoundKey<T>> rows_;
};

/// A parsed file. Throws StartupError when it cannot be read or is not TOML.
class TomlFile {
 public:
  /// `keys` outlives it. `settings`, KEY=VALUE each (hal/setting_keys.h), stand in place of the file's own.
  TomlFile(const std::filesystem::path& file, const FileKeys& keys, const std::vector<std::string>& settings = {});
  [[nodiscard]] TomlTable root() const { return {file_, *keys_, table_, ""}; }

 private:
  const FileKeys* keys_;
  std::filesystem::path file_;
  toml::value table_;
};

}  // namespace jaywalk
