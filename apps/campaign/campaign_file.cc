#include <algorithm>

#include "apps/campaign/campaign.h"
#include "hal/toml_file.h"
#include "hal/types/errors.h"

namespace jaywalk::campaign {
namespace {

using enum KeyKind;

constexpr double kMostSeeds = 1e6;

std::optional<SeedRange> read_seeds(TomlTable& table) {
  if (!table.has("seeds")) return std::nullopt;
  const std::vector<double> seeds = table.numbers("seeds", 2);
  const bool whole = std::all_of(seeds.begin(), seeds.end(), [](double seed) {
    return seed >= 0.0 && seed <= 1e15 && seed == static_cast<double>(static_cast<std::uint64_t>(seed));
  });
  if (!whole || seeds[1] < seeds[0] || seeds[1] - seeds[0] >= kMostSeeds)
    table.refuse("seeds", "is no range of seeds", "write [first, last], whole numbers, at most a million seeds");
  return SeedRange{static_cast<std::uint64_t>(seeds[0]), static_cast<std::uint64_t>(seeds[1])};
}

/// Names become folders.
std::string read_name(TomlTable& table) {
  constexpr const char* kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  std::string name = table.text("name");
  if (name.empty() || name.find_first_not_of(kLetters) != std::string::npos)
    table.refuse("name", "is no name of a folder", "use letters, digits, - and _");
  return name;
}

/// An option of jaywalk sim that may be varied: `choices`, of which the first is the usual one.
Axis read_option(TomlTable& table, const std::string& key, const std::vector<std::string>& choices) {
  std::vector<std::string> values = table.has(key) ? table.texts(key) : std::vector<std::string>{choices.front()};
  for (const std::string& value : values)
    if (std::find(choices.begin(), choices.end(), value) == choices.end())
      table.refuse(key, "is \"" + value + "\"", "choose of " + joined(choices) + ", several in a list");
  return {key, std::move(values), table.place_of(key), true};
}

std::vector<Axis> read_axes(TomlTable& table) {
  std::vector<Axis> axes;
  for (const ListedKey& key : table.listed("set")) axes.push_back({key.name, key.values, key.place, false});
  axes.push_back(read_option(table, "planner", {"ours", "none", "replan", "dwa", "orca"}));
  axes.push_back(read_option(table, "mode", {"full", "paper"}));
  return axes;
}

Experiment read_experiment(TomlTable& table) {
  Experiment experiment;
  experiment.place = table.place_of("name");
  experiment.name = read_name(table);
  experiment.title = table.text("title", experiment.name);
  experiment.scenarios = table.texts("scenarios");
  experiment.seeds = read_seeds(table);
  experiment.constant_speed = table.boolean("constant_speed");
  experiment.axes = read_axes(table);
  table.finish();
  return experiment;
}

void refuse_equal_names(const std::vector<Experiment>& experiments) {
  for (const Experiment& one : experiments) {
    for (const Experiment& other : experiments)
      if (&one < &other && one.name == other.name)
        throw StartupError(other.place + "experiments.name " + one.name + " is there already", "give it another name");
  }
}

}  // namespace

const FileKeys& campaign_keys() {
  static const FileKeys keys = file_keys(
      "Campaign",
      {section_keys("", {key_row("name", kText, "the file's name", "for reports"),
                         key_row("title", kText, "the name", "heading of the report"),
                         choice_row("keep", "failures", "what stays of a run's files", {"figures", "failures", "all"}),
                         key_row("experiments", kTables, kNeeded, "what is run")}),
       section_keys("experiments",
                    {key_row("name", kText, kNeeded, "of its folder: letters, digits, - and _"),
                     key_row("title", kText, "the name", "heading of its tables"),
                     key_row("scenarios", kTexts, kNeeded, "scenario files, relative to this file's folder"),
                     key_row("seeds", kNumbers, "each scenario's own", "[first, last]"),
                     key_row("planner", kTexts, "ours",
                             "who decides on motion: ours, none, replan, dwa, orca; a list to vary it"),
                     key_row("mode", kTexts, "full", "full, paper, or both in a list"),
                     key_row("constant_speed", kBoolean, false, "one speed from start to goal, never stopping"),
                     key_row("set", kTable, "nothing", "keys of the scenario: a value, or a list to vary it")})});
  return keys;
}

Campaign load_campaign(const std::filesystem::path& path) {
  const TomlFile file(path, campaign_keys());
  TomlTable root = file.root();
  Campaign campaign;
  campaign.file = path;
  campaign.name = root.text("name", path.stem().string());
  campaign.title = root.text("title", campaign.name);
  if (root.has("keep")) campaign.keep = static_cast<Keep>(root.choice("keep"));  // choices in the enumeration's order
  for (TomlTable& table : root.tables("experiments")) campaign.experiments.push_back(read_experiment(table));
  root.finish();
  if (campaign.experiments.empty())
    root.refuse("experiments", "is missing", "write [[experiments]] and its keys below");
  refuse_equal_names(campaign.experiments);
  return campaign;
}

}  // namespace jaywalk::campaign
