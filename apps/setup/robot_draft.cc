#include "apps/setup/robot_draft.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <istream>
#include <ostream>

#include "firmware/robot/robot_file.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr std::size_t kWidest = 158;  // of a line

/// "  # meaning (unit); note", cut where the line would be too long.
std::string comment(const SettingKey& row, const std::string& note, std::size_t taken) {
  const std::string unit = row.unit[0] == '\0' ? "" : std::string(" (") + row.unit + ")";
  const std::string text = std::string("  # ") + row.meaning + unit + (note.empty() ? "" : "; " + note);
  return taken + text.size() > kWidest ? "  # " + note : text;
}

constexpr std::array kSections{"drive", "panel", "realtime"};

/// The name that a draft's section has in the file: "laser" for "laser 2".
std::string section_in_file(const std::string& section) { return section.substr(0, section.find(' ')); }

/// What stands under the row's key, checked by the row, as TOML writes it. The key is there. Throws StartupError.
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

/// What a person typed, as TOML writes it; nothing where it is no value of this key.
std::optional<std::string> understood(const SettingKey& row, const std::string& said) {
  char* end = nullptr;
  const double number = std::strtod(said.c_str(), &end);
  const bool is_number = !said.empty() && *end == '\0' && number >= row.range.low && number <= row.range.high;
  switch (row.kind) {
    case KeyKind::kNumber: return is_number ? std::optional(literal(number)) : std::nullopt;
    case KeyKind::kInteger:
      return is_number && number == std::floor(number) ? std::optional(literal(number)) : std::nullopt;
    case KeyKind::kBoolean:
      if (said == "true" || said == "yes") return "true";
      return said == "false" || said == "no" ? std::optional<std::string>("false") : std::nullopt;
    case KeyKind::kNumbers: return said.starts_with("[") && said.ends_with("]") ? std::optional(said) : std::nullopt;
    case KeyKind::kChoice:
      return std::ranges::count(row.choices, said) > 0 ? std::optional(literal(said)) : std::nullopt;
    default: return said.empty() ? std::nullopt : std::optional(literal(said));
  }
}

std::string title(const SettingKey& row, const std::string& section) {
  return section.empty() ? row.key : section + "." + row.key;
}

}  // namespace

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
  for (const char* section : kSections) text += text_of(section);
  const auto places = tables_.find("places");
  return places == tables_.end() ? text : text + places->second;
}

std::string laser_section(std::size_t scanner) {
  return scanner == 0 ? "laser" : "laser " + std::to_string(scanner + 1);
}

std::string literal(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += (c == '"' || c == '\\') ? std::string("\\") + c : std::string(1, c);
  return quoted + "\"";
}

std::string literal(double number) { return formatted("%.10g", number); }

const SettingKey& SetupAnswers::row_of(const std::string& section, const std::string& key) const {
  const bool of_kind = section == "drive" && !kind_.empty();
  return robot_file_keys().find(of_kind ? section + ":" + kind_ : section_in_file(section), key);
}

SetupAnswers::SetupAnswers(const std::optional<std::filesystem::path>& file, std::istream* from, std::ostream* to,
                           std::filesystem::path kept)
    : from_(from), to_(to), kept_(std::move(kept)) {
  std::ifstream in(kept_);
  for (std::string question, answer; std::getline(in, question, '\t') && std::getline(in, answer);)
    earlier_.emplace_back(question, answer);
  if (!file) return;
  name_ = file->string();
  file_ = std::make_unique<TomlFile>(*file, robot_file_keys());
  TomlTable root = file_->root();
  for (const char* section : kSections)
    if (root.has(section)) tables_.emplace(section, root.table(section));
  if (root.has("laser"))
    for (const TomlTable& laser : root.table_or_tables("laser")) tables_.emplace(laser_section(scanners_++), laser);
  tables_.emplace("", root);
  const toml::value raw = toml::parse(*file);
  for (const auto& [section, table] : tables_)
    if (section.empty())
      refuse_unknown(section, raw);
    else if (const toml::value& inner = raw.at(section_in_file(section)); inner.is_table())
      refuse_unknown(section, inner);
}

void SetupAnswers::refuse_unknown(const std::string& section, const toml::value& raw) {
  std::vector<std::string> known;
  for (const SettingKey& row : robot_file_keys().keys)
    if (row.section == section || row.section.starts_with(section + ":")) known.push_back(row.key);
  for (const auto& [key, value] : raw.as_table())
    if (std::ranges::find(known, key) == known.end())
      table(section)->refuse(key, "is not a known key", did_you_mean(key, known, "remove it or correct its spelling"));
}

TomlTable* SetupAnswers::table(const std::string& section) {
  const auto found = tables_.find(section);
  return found == tables_.end() ? nullptr : &found->second;
}

std::optional<std::string> SetupAnswers::given(const std::string& section, const std::string& key) {
  TomlTable* const found = table(section);
  if (found == nullptr || !found->has(key)) return std::nullopt;
  return literal_of(*found, row_of(section, key));
}

void SetupAnswers::take_kind(const std::string& kind) {
  kind_ = kind;
  if (TomlTable* const drive = table("drive")) drive->take_keys_of(kind);
}

void SetupAnswers::settle(RobotDraft& draft, const std::string& section, const std::string& key,
                          const std::string& suggestion, const std::string& note, const Check& check) {
  if (const auto known = given(section, key)) return draft.set(section, key, *known, "as answered");
  const SettingKey& row = row_of(section, key);
  if (asks()) return draft.set(section, key, ask(row, section, suggestion, check), "as answered");
  if (suggestion.empty())
    throw StartupError("setup: " + title(row, section) + " cannot be seen: " + row.meaning,
                       "put it into " + name_ + ", as ROBOT.toml has it");
  draft.set(section, key, suggestion, note);
}

std::string SetupAnswers::line(const std::string& question) {
  const auto earlier = std::ranges::find(earlier_, question, &Answer::first);
  if (earlier != earlier_.end()) {
    std::string said = earlier->second;
    earlier_.erase(earlier);
    *to_ << said << " (as answered before)\n";
    return said;
  }
  std::string said;
  to_->flush();
  if (!std::getline(*from_, said))
    throw StartupError("setup: the answers end here",
                       kept_.empty() ? "answer all questions, or give --answers FILE"
                                     : "run it again: " + kept_.string() + " has what was answered");
  return said;
}

void SetupAnswers::keep(const std::string& question, const std::string& answer) {
  said_.emplace_back(question, answer);
  if (kept_.empty()) return;
  std::ofstream out(kept_);
  for (const auto* answers : {&said_, &earlier_})
    for (const auto& [asked, said] : *answers) out << asked << '\t' << said << '\n';
}

std::string SetupAnswers::ask(const SettingKey& row, const std::string& section, const std::string& suggestion,
                              const Check& check) {
  const std::string unit = row.unit[0] == '\0' ? "" : std::string(" ") + row.unit;
  for (;;) {
    *to_ << title(row, section) << ": " << row.meaning << " (" << allowed(row) << unit << ")"
         << (suggestion.empty() ? "" : " [" + suggestion + "]") << ": ";
    const std::string said = line(title(row, section));
    const auto value = said.empty() && !suggestion.empty() ? suggestion : understood(row, said);
    const std::string complaint = !value ? "not one of these: " + allowed(row) : check ? check(*value) : "";
    if (complaint.empty()) return keep(title(row, section), said), *value;
    *to_ << complaint << "\n";
  }
}

std::size_t SetupAnswers::choose(const std::string& what, const std::vector<std::string>& among) {
  if (among.size() < 2 || !asks()) return 0;
  for (std::size_t k = 0; k < among.size(); ++k) *to_ << "  " << k + 1 << "  " << among[k] << "\n";
  for (;;) {
    *to_ << what << ": which of these (1 to " << among.size() << ")? ";
    const std::string said = line(what);
    const auto named = std::ranges::find(among, said);
    const std::size_t number = named != among.end() ? static_cast<std::size_t>(named - among.begin()) + 1
                                                    : std::strtoul(said.c_str(), nullptr, 10);
    if (number >= 1 && number <= among.size()) return keep(what, among[number - 1]), number - 1;
  }
}

bool SetupAnswers::agrees(const std::string& question) {
  if (!asks()) return false;
  *to_ << question << " [yes/no] ";
  const std::string said = line(question);
  keep(question, said);
  return said == "yes";
}

void SetupAnswers::take_tables(RobotDraft& draft, TomlTable& parent, const std::string& section,
                               const std::string& key) {
  const std::string name = section.empty() ? key : section_in_file(section) + "." + key;
  for (TomlTable& each : parent.tables(key)) {
    std::vector<std::pair<std::string, std::string>> keys;
    for (const SettingKey& row : robot_file_keys().keys)
      if (row.section == name && each.has(row.key)) keys.emplace_back(row.key, literal_of(each, row));
    each.finish();
    draft.add_table(section, key, keys);
  }
}

void SetupAnswers::finish_section(RobotDraft& draft, const std::string& section, TomlTable& table) {
  for (const SettingKey& row : robot_file_keys().keys) {
    const bool mine =
        row.section == section_in_file(section) || (section == "drive" && row.section == "drive:" + kind_);
    if (!mine || row.kind == KeyKind::kTable || !table.has(row.key)) continue;
    if (row.kind == KeyKind::kTables)
      take_tables(draft, table, section, row.key);
    else if (!draft.has(section, row.key))
      draft.set(section, row.key, literal_of(table, row), "as answered");
    else
      static_cast<void>(literal_of(table, row));  // known by now
  }
  table.finish();
}

}  // namespace jaywalk
