#include <algorithm>
#include <cstring>
#include <map>

#include "apps/campaign/campaign.h"
#include "hal/maps/wall_map.h"
#include "hal/sim/scenario.h"
#include "hal/types/errors.h"

namespace jaywalk::campaign {
namespace {

constexpr std::size_t kMostRuns = 10'000'000;

/// A value for each axis.
using Combination = std::vector<std::string>;

std::vector<Combination> combinations_of(const std::vector<Axis>& axes) {
  std::vector<Combination> all{{}};
  for (const Axis& axis : axes) {
    std::vector<Combination> longer;
    for (const Combination& begun : all) {
      for (const std::string& value : axis.values) {
        longer.push_back(begun);
        longer.back().push_back(value);
      }
    }
    all = std::move(longer);
  }
  return all;
}

/// Letters that a name of a folder may have; a path's own become '_'.
std::string folder_part(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '/' || c == '\\' || c == ' '; }, '_');
  return text;
}

/// What tells a row from the others: the axes that vary.
std::string row_of(const Experiment& experiment, const Combination& values, const char* equals, const char* between) {
  std::string row;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (experiment.axes[k].values.size() < 2) continue;
    row += (row.empty() ? "" : between) + experiment.axes[k].name + equals + values[k];
  }
  return row.empty() ? "all" : row;
}

std::vector<std::string> settings_of(const Experiment& experiment, const Combination& values) {
  std::vector<std::string> settings;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (!experiment.axes[k].is_option) settings.push_back(experiment.axes[k].name + "=" + values[k]);
  return settings;
}

bool names_file(const std::string& axis) {
  const std::vector<SettingKey>& keys = sim::scenario_keys().keys;
  return std::any_of(keys.begin(), keys.end(), [&](const SettingKey& key) {
    return key.kind == KeyKind::kFile && key.section.substr(0, key.section.find(':')) + "." + key.key == axis;
  });
}

/// As they are in the campaign file's folder, for a process that works elsewhere.
std::vector<std::string> settings_from(const std::filesystem::path& folder, std::vector<std::string> settings) {
  for (std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    const std::string axis = setting.substr(0, equals);
    if (names_file(axis)) setting = axis + "=" + (folder / setting.substr(equals + 1)).string();
  }
  return settings;
}

std::vector<std::string> arguments_of(const Experiment& experiment, const Combination& values,
                                      const std::string& scenario) {
  std::vector<std::string> arguments{"sim", scenario};
  for (std::size_t k = 0; k < values.size(); ++k)
    if (experiment.axes[k].is_option) arguments.insert(arguments.end(), {"--" + experiment.axes[k].name, values[k]});
  if (experiment.constant_speed) arguments.push_back("--constant-speed");
  for (const std::string& setting : settings_of(experiment, values)) {
    arguments.push_back("--set");
    arguments.push_back(setting);
  }
  return arguments;
}

/// Where the campaign file says what a refusal of `setting` is about.
std::string place_of(const Experiment& experiment, const std::string& refusal) {
  for (const Axis& axis : experiment.axes)
    if (refusal.rfind("--set " + axis.name + "=", 0) == 0) return axis.place + "experiments.set ";
  return experiment.place;
}

sim::Scenario scenario_for(const Campaign& campaign, const Experiment& experiment, const std::string& scenario,
                           const std::vector<std::string>& settings) {
  try {
    const std::filesystem::path folder = campaign.file.parent_path();
    return sim::load_scenario(folder / scenario, settings_from(folder, settings));
  } catch (const StartupError& refusal) {
    const std::string text = refusal.what(), place = place_of(experiment, text);
    const bool set = place != experiment.place;
    const std::size_t remedy = text.rfind("; ");
    throw StartupError(place + text.substr(set ? std::strlen("--set ") : 0, remedy - (set ? std::strlen("--set ") : 0)),
                       text.substr(remedy + 2));
  }
}

/// `own_seed`: the scenario's.
void add_seeds(const Experiment& experiment, std::uint64_t own_seed, const PlannedRun& without_seed,
               std::vector<PlannedRun>& runs) {
  const SeedRange seeds = experiment.seeds.value_or(SeedRange{own_seed, own_seed});
  if (runs.size() + (seeds.last - seeds.first) >= kMostRuns)
    throw StartupError(experiment.place + "more than ten million runs", "divide the campaign");
  for (std::uint64_t seed = seeds.first; seed <= seeds.last; ++seed) {
    PlannedRun run = without_seed;
    run.seed = seed;
    run.folder += "/" + std::to_string(seed);
    run.arguments.insert(run.arguments.end(), {"--seed", std::to_string(seed)});
    runs.push_back(std::move(run));
  }
}

void note_inputs(const std::filesystem::path& file, const sim::Scenario& scenario,
                 std::set<std::filesystem::path>& inputs) {
  inputs.insert(file);
  for (const std::filesystem::path& part : sim::files_of_map(scenario.map_kind, scenario.map_file)) inputs.insert(part);
  for (const sim::RecordedSpec& movers : scenario.recorded) inputs.insert(movers.file);
}

void refuse_equal_folders(const Campaign& campaign, const std::vector<PlannedRun>& runs) {
  std::map<std::string, const PlannedRun*> seen;
  for (const PlannedRun& run : runs) {
    if (!seen.emplace(run.folder, &run).second)
      throw StartupError(campaign.file.string() + ": two runs are called " + run.folder,
                         "give scenarios of one experiment different file names, and each value once");
  }
}

}  // namespace

Plan plan_of(const Campaign& campaign) {
  Plan plan;
  for (const Experiment& experiment : campaign.experiments) {
    for (const Combination& values : combinations_of(experiment.axes)) {
      for (const std::string& scenario : experiment.scenarios) {
        const sim::Scenario read = scenario_for(campaign, experiment, scenario, settings_of(experiment, values));
        note_inputs(campaign.file.parent_path() / scenario, read, plan.inputs);
        const std::string stem = std::filesystem::path(scenario).stem().string();
        const std::string row = folder_part(row_of(experiment, values, "=", ","));
        add_seeds(experiment, read.seed,
                  {.experiment = experiment.name,
                   .row = row_of(experiment, values, " ", ", "),
                   .values = values,
                   .scenario = stem,
                   .folder = experiment.name + "/" + row + "/" + folder_part(stem),
                   .arguments = arguments_of(experiment, values, scenario),
                   .goal = read.goal,
                   .cruise_mps = read.model.limits.max_speed_mps},
                  plan.runs);
      }
    }
  }
  refuse_equal_folders(campaign, plan.runs);
  return plan;
}

std::string command_of(const PlannedRun& run) {
  std::string command = "jaywalk";
  for (const std::string& word : run.arguments) {
    const bool plain = word.find_first_of(" $`\"\\*?&;|<>()") == std::string::npos;
    command += " " + (plain ? word : "'" + word + "'");
  }
  return command + " --out " + "out/" + run.folder;
}

}  // namespace jaywalk::campaign
