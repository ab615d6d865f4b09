#include "hal/toml_file.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <regex>
#include <sstream>

#include "hal/shown_text.h"
#include "hal/text_file.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

// toml11 3 and 4 say differently where something stands.
template <class Location>
std::size_t line_of(const Location& where) {
  if constexpr (requires { where.first_line_number(); })
    return where.first_line_number();
  else
    return where.line();
}

template <class SyntaxError>
std::size_t line_of_mistake(const SyntaxError& e) {
  if constexpr (requires { e.location(); })
    return line_of(e.location());
  else
    return line_of(e.errors().front().locations().front().first);
}

// The whole of a file has no line in toml11 4; a mistake in it is shown at the first.
std::string place(const std::filesystem::path& file, std::size_t line) {
  return file.string() + ":" + std::to_string(std::max<std::size_t>(line, 1)) + ": ";
}

std::string written(double value) { return formatted("%g", value); }

// The library draws a picture of several lines; what is wrong stands at the end of the first, behind a function's name.
std::string cause_in(const std::string& text) {
  const std::string line = text.substr(0, text.find('\n'));
  const std::size_t name = line.find("toml::");
  const std::size_t colon = name == std::string::npos ? name : line.find(": ", name);
  return colon == std::string::npos ? line : line.substr(colon + 2);
}

/// The parser calls itself for each bracket within another, and 20,000 break the stack. Those in texts count, too.
constexpr int kDeepestNesting = 500;

void refuse_deep_nesting(const std::filesystem::path& file, const std::string& text) {
  std::uint32_t line = 1;
  int depth = 0;
  for (const char c : text) {
    if (c == '\n') ++line;
    if (c == '[' || c == '{') ++depth;
    if ((c == ']' || c == '}') && depth > 0) --depth;
    if (depth > kDeepestNesting) throw StartupError(place(file, line) + "brackets within brackets", "write valid TOML");
  }
}

/// toml11 3.7 ends the program by an assertion at some mistakes behind one. No key of ours needs one.
void refuse_texts_of_several_lines(const std::filesystem::path& file, const std::string& text) {
  std::istringstream stream(text);
  std::size_t number = 1;
  for (std::string line; std::getline(stream, line); ++number)
    if (line.find("'''") != std::string::npos || line.find("\"\"\"") != std::string::npos)
      throw StartupError(place(file, number) + "three quotes begin a text of several lines", "write it in one line");
}

/// A decimal comma where a number stands alone, which TOML has no word for.
void refuse_decimal_comma(const std::filesystem::path& file, const std::string& text, std::size_t number) {
  std::istringstream stream(text);
  std::string line;
  for (std::size_t k = 0; k < number && std::getline(stream, line); ++k) continue;
  static const std::regex kComma("^[^\"'\\[#]*=\\s*([-+]?[0-9]+),([0-9]+)\\s*(#.*)?$");
  std::smatch found;
  if (std::regex_match(line, found, kComma))
    throw StartupError(place(file, number) + "a number with a comma", "write " + found[1].str() + "." + found[2].str());
}

toml::value parse(const std::filesystem::path& file) {
  const std::string text = whole_text(file, file.string() + ": ", "give the path of a TOML file");
  refuse_deep_nesting(file, text);
  refuse_texts_of_several_lines(file, text);
  try {
    std::istringstream stream(text);
    return toml::parse(stream, file.string());
  } catch (const toml::syntax_error& e) {
    refuse_decimal_comma(file, text, line_of_mistake(e));
    throw StartupError(place(file, line_of_mistake(e)) + cause_in(e.what()), "write valid TOML");
  } catch (const std::exception& e) {  // a date or number that does not exist
    throw StartupError(place(file, 0) + cause_in(e.what()), "write valid TOML");
  }
}

double as_number(const toml::value& value) {
  return value.is_integer() ? static_cast<double>(value.as_integer()) : value.as_floating();
}

bool is_number(const toml::value& value) { return value.is_integer() || value.is_floating(); }

const toml::value* look_up(const toml::value& table, const std::string& key) {
  return table.contains(key) ? &table.at(key) : nullptr;
}

}  // namespace

TomlFile::TomlFile(const std::filesystem::path& file, const FileKeys& keys, const std::vector<std::string>& settings)
    : keys_(&keys), file_(file), table_(parse(file)) {
  for (const std::string& setting : settings) apply_setting(table_, keys, file, setting);
}

std::string TomlTable::place_of(const std::string& key) const {
  const toml::value* node = look_up(*table_, key);
  const auto where = node != nullptr ? node->location() : table_->location();
  const std::string source = where.file_name();
  return source.rfind(kGivenPlace, 0) == 0 ? source + ": " : place(*file_, line_of(where));
}

std::size_t TomlTable::line(const std::string& key) const { return line_of(table_->at(key).location()); }

void TomlTable::refuse(const std::string& key, const std::string& cause, const std::string& remedy) const {
  throw StartupError(place_of(key) + title(key) + " " + cause, remedy);
}

const toml::value* TomlTable::find(const std::string& key) {
  static_cast<void>(row(key));
  asked_.insert(key);
  return look_up(*table_, key);
}

const toml::value& TomlTable::need(const std::string& key) {
  const toml::value* node = find(key);
  if (node == nullptr) {
    refuse_misspelt(key);
    refuse(key, "is missing", "add it");
  }
  return *node;
}

void TomlTable::refuse_misspelt(const std::string& key) const {
  for (const auto& [other, value] : table_->as_table()) {
    const bool is_known = keys_->has(section_, other) || !keys_->choice_with(name_, other).empty();
    const std::string meant = is_known ? "" : did_you_mean(other, {key}, "");
    if (!meant.empty()) refuse(printable(other), "is not a known key", meant);
  }
}

double TomlTable::number_from(const std::string& key, const toml::value& node, Range range) const {
  if (!is_number(node)) refuse(key, "is not a number", "write a number");
  const double value = as_number(node);
  if (!(value >= range.low && value <= range.high))
    refuse(key, "is " + written(value), "choose a value from " + written(range.low) + " to " + written(range.high));
  return value;
}

std::int64_t TomlTable::integer(const std::string& key, std::optional<std::int64_t> otherwise) {
  const toml::value* node = find_number(key, otherwise);
  if (node == nullptr) return *otherwise;
  if (!node->is_integer()) refuse(key, "is not a whole number", "write a whole number");
  static_cast<void>(number_from(key, *node, row(key).range));  // refuses what is outside
  return node->as_integer();
}

bool TomlTable::boolean(const std::string& key, std::optional<bool> otherwise) {
  const toml::value* node = find(key);
  if (node == nullptr) return otherwise ? *otherwise : std::get<bool>(row(key).otherwise);
  if (!node->is_boolean()) refuse(key, "is not true or false", "write true or false");
  return node->as_boolean();
}

std::size_t TomlTable::choice(const std::string& key) {
  const std::string word = text(key);
  const std::vector<std::string>& choices = row(key).choices;
  const auto found = std::find(choices.begin(), choices.end(), word);
  if (found == choices.end()) refuse(key, "is \"" + word + "\"", "choose one of " + joined(choices));
  return static_cast<std::size_t>(found - choices.begin());
}

std::string TomlTable::text(const std::string& key) {
  const toml::value& node = need(key);
  if (!node.is_string()) refuse(key, "is not a text", "write it in quotes");
  std::string said = toml::get<std::string>(node);
  if (said != printable(said)) refuse(key, "holds a control character", "write letters that can be printed");
  return said;
}

std::vector<double> TomlTable::numbers_from(const std::string& key, const toml::value& node, std::size_t least,
                                            std::size_t most) const {
  const std::string counts = std::to_string(least) + (most > least ? " or " + std::to_string(most) : "");
  const std::string remedy = "write [ ] with " + counts + " numbers";
  if (!node.is_array()) refuse(key, "is not an array", remedy);
  const toml::array& array = node.as_array();
  if (array.size() != least && array.size() != most)
    refuse(key, "has " + std::to_string(array.size()) + " elements", remedy);
  std::vector<double> values;
  for (const toml::value& item : array) {
    if (!is_number(item) || !std::isfinite(as_number(item))) refuse(key, "holds what is no number", remedy);
    values.push_back(as_number(item));
  }
  return values;
}

void TomlTable::require_in_map(const std::string& key, const std::vector<double>& values) const {
  constexpr double kFarthest_m = 1e5;
  for (std::size_t k = 0; k < 2; ++k)
    if (std::fabs(values[k]) > kFarthest_m)
      refuse(key, "lies at " + written(values[k]) + " m", "give metres in the map's frame, at most 100000");
}

std::vector<double> TomlTable::place_in_map(const std::string& key, std::size_t least) {
  constexpr double kOneTurn_rad = 2.0 * kPi;
  const std::vector<double> values = numbers(key, least, 3);
  require_in_map(key, values);
  if (values.size() == 3 && std::fabs(values[2]) > kOneTurn_rad)
    refuse(key, "has the heading " + written(values[2]) + " rad",
           "give radians: " + written(values[2]) + " degrees are " + written(wrap_angle(values[2] * kPi / 180.0)));
  return values;
}

std::vector<TomlTable> TomlTable::tables(const std::string& key) {
  std::vector<TomlTable> found;
  const toml::value* node = find(key);
  if (node == nullptr) return found;
  const std::string remedy = "write [[" + title(key) + "]] and its keys below";
  if (!node->is_array()) refuse(key, "is not a list of tables", remedy);
  for (const toml::value& item : node->as_array()) {
    if (!item.is_table()) refuse(key, "is not a list of tables", remedy);
    found.emplace_back(*file_, *keys_, item, title(key));
  }
  return found;
}

std::filesystem::path TomlTable::existing_file(const std::string& key, const std::string& remedy) {
  const std::filesystem::path named = text(key);
  std::filesystem::path file = named.is_absolute() ? named : file_->parent_path() / named;
  if (!std::filesystem::is_regular_file(file)) refuse(key, "names " + file.string() + ", which is no file", remedy);
  return file;
}

void TomlTable::finish() const {
  std::size_t line = 0;
  std::string unknown;
  for (const auto& [key, value] : table_->as_table()) {  // in no order
    const std::size_t here = line_of(value.location());
    const bool earlier = unknown.empty() || here < line || (here == line && key < unknown);
    if (asked_.count(key) == 0 && earlier) line = here, unknown = key;
  }
  if (unknown.empty()) return;
  if (const std::string kind = keys_->choice_with(name_, unknown); !kind.empty())
    refuse(unknown, "is not a known key of this kind, but of \"" + kind + "\"", "remove it, or choose that one");
  refuse(printable(unknown), "is not a known key",
         did_you_mean(unknown, {asked_.begin(), asked_.end()}, "remove it or correct its spelling"));
}

}  // namespace jaywalk
