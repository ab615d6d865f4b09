#include "apps/campaign/campaign.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <regex>

#include "hal/maps/wall_map.h"
#include "hal/sim/scenario.h"
#include "hal/types/errors.h"

namespace jaywalk::campaign {
namespace {

using enum KeyKind;

constexpr double kMostSeeds = 1e6;

std::optional<std::pair<std::uint64_t, std::uint64_t>> read_seeds(TomlTable& table) {
  if (!table.has("seeds")) return std::nullopt;
  const std::vector<double> seeds = table.numbers("seeds", 2);
  const bool whole = std::all_of(seeds.begin(), seeds.end(), [](double seed) {
    return seed >= 0.0 && seed <= 1e15 && seed == static_cast<double>(static_cast<std::uint64_t>(seed));
  });
  if (!whole || seeds[1] < seeds[0] || seeds[1] - seeds[0] >= kMostSeeds)
    table.refuse("seeds", "is no range of seeds", "write [first, last], whole numbers, at most a million seeds");
  return std::pair{static_cast<std::uint64_t>(seeds[0]), static_cast<std::uint64_t>(seeds[1])};
}

/// Names become folders.
std::string read_name(TomlTable& table) {
  std::string name = table.text("name");
  if (!std::regex_match(name, std::regex("[A-Za-z0-9_-]+")))
    table.refuse("name", "is no name of a folder", "use letters, digits, - and _");
  return name;
}

/// An option of jaywalk sim that may be varied: `choices`, of which the first is the usual one.
Axis read_option(TomlTable& table, const std::string& key, const std::vector<std::string>& choices) {
  std::vector<std::string> values = table.has(key) ? table.texts(key) : std::vector<std::string>{choices.front()};
  for (const std::string& value : values)
    if (std::ranges::count(choices, value) == 0)
      table.refuse(key, "is \"" + value + "\"", "choose of " + joined(choices) + ", several in a list");
  return {{key, std::move(values), table.place_of(key)}, true};
}

std::vector<Axis> read_axes(TomlTable& table) {
  std::vector<Axis> axes;
  for (const ListedKey& key : table.listed("set")) axes.push_back({key, false});
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
  std::set<std::string> names;
  for (const Experiment& one : experiments)
    if (!names.insert(one.name).second)
      throw StartupError(one.place + "experiments.name " + one.name + " is there already", "give it another name");
}

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
  std::ranges::replace_if(
      text, [](char c) { return c == '/' || c == '\\' || c == ' '; }, '_');
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

bool names_file(const std::string& axis) {
  const std::vector<SettingKey>& keys = sim::scenario_keys().keys;
  return std::any_of(keys.begin(), keys.end(), [&](const SettingKey& key) {
    return key.kind == KeyKind::kFile && key.section.substr(0, key.section.find(':')) + "." + key.key == axis;
  });
}

/// KEY=VALUE each. `folder`: the campaign file's, to which names of files are relative; empty for a process in it.
std::vector<std::string> settings_of(const Experiment& experiment, const Combination& values,
                                     const std::filesystem::path& folder) {
  std::vector<std::string> settings;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const std::string& axis = experiment.axes[k].name;
    if (experiment.axes[k].is_option) continue;
    settings.push_back(axis + "=" + (names_file(axis) ? (folder / values[k]).string() : values[k]));
  }
  return settings;
}

std::vector<std::string> arguments_of(const Experiment& experiment, const Combination& values,
                                      const std::string& scenario) {
  std::vector<std::string> arguments{"sim", scenario};
  for (std::size_t k = 0; k < values.size(); ++k)
    if (experiment.axes[k].is_option) arguments.insert(arguments.end(), {"--" + experiment.axes[k].name, values[k]});
  if (experiment.constant_speed) arguments.push_back("--constant-speed");
  for (const std::string& setting : settings_of(experiment, values, ""))
    arguments.insert(arguments.end(), {"--set", setting});
  return arguments;
}

/// Where the campaign file says what a refusal of `setting` is about.
std::string place_of(const Experiment& experiment, const std::string& refusal) {
  for (const Axis& axis : experiment.axes)
    if (refusal.starts_with(kGivenPlace + axis.name + "=")) return axis.place + "experiments.set ";
  return experiment.place;
}

sim::Scenario scenario_for(const Campaign& campaign, const Experiment& experiment, const std::string& scenario,
                           const Combination& values) {
  try {
    const std::filesystem::path folder = campaign.file.parent_path();
    return sim::load_scenario(folder / scenario, settings_of(experiment, values, folder));
  } catch (const StartupError& refusal) {
    const std::string text = refusal.what(), place = place_of(experiment, text);
    const std::size_t begin = place == experiment.place ? 0 : std::strlen(kGivenPlace), remedy = text.rfind("; ");
    throw StartupError(place + text.substr(begin, remedy - begin), text.substr(remedy + 2));
  }
}

std::string command_of(const PlannedRun& run) {
  std::string command = "jaywalk";
  for (const std::string& word : run.arguments) {
    const bool plain = word.find_first_of(" $`\"\\*?&;|<>()") == std::string::npos;
    command += " " + (plain ? word : "'" + word + "'");
  }
  return command + " --out " + "out/" + run.folder;
}

/// `own_seed`: the scenario's.
void add_seeds(const Experiment& experiment, std::uint64_t own_seed, const PlannedRun& without_seed,
               std::vector<PlannedRun>& runs) {
  const auto [first, last] = experiment.seeds.value_or(std::pair{own_seed, own_seed});
  if (runs.size() + (last - first) >= kMostRuns)
    throw StartupError(experiment.place + "more than ten million runs", "divide the campaign");
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    PlannedRun run = without_seed;
    run.seed = seed;
    run.folder += "/" + std::to_string(seed);
    run.arguments.insert(run.arguments.end(), {"--seed", std::to_string(seed)});
    run.command = command_of(run);
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
  std::set<std::string> seen;
  for (const PlannedRun& run : runs)
    if (!seen.insert(run.folder).second)
      throw StartupError(campaign.file.string() + ": two runs are called " + run.folder,
                         "give scenarios of one experiment different file names, and each value once");
}

constexpr int kNotStarted = 127;

/// Between fork and exec: nothing here allocates.
[[noreturn]] void become(const char* program, const char* folder, const char* said, char* const* words, pid_t parent) {
  ::setpgid(0, 0);  // Ctrl-C is for the campaign, which then ends its runs
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent || ::chdir(folder) != 0) ::_exit(kNotStarted);
  const int file = ::open(said, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file < 0 || ::dup2(file, STDOUT_FILENO) < 0 || ::dup2(file, STDERR_FILENO) < 0) ::_exit(kNotStarted);
  ::execv(program, words);
  ::_exit(kNotStarted);
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
  const std::string name = root.text("name", path.stem().string());
  campaign.title = root.text("title", name);
  if (root.has("keep")) campaign.keep = static_cast<Keep>(root.choice("keep"));  // choices in the enumeration's order
  for (TomlTable& table : root.tables("experiments")) campaign.experiments.push_back(read_experiment(table));
  root.finish();
  if (campaign.experiments.empty())
    root.refuse("experiments", "is missing", "write [[experiments]] and its keys below");
  refuse_equal_names(campaign.experiments);
  return campaign;
}

Plan plan_of(const Campaign& campaign) {
  Plan plan;
  for (const Experiment& experiment : campaign.experiments) {
    for (const Combination& values : combinations_of(experiment.axes)) {
      for (const std::string& scenario : experiment.scenarios) {
        const sim::Scenario read = scenario_for(campaign, experiment, scenario, values);
        note_inputs(campaign.file.parent_path() / scenario, read, plan.inputs);
        const std::string stem = std::filesystem::path(scenario).stem().string();
        const std::string row = folder_part(row_of(experiment, values, "=", ","));
        add_seeds(experiment, read.seed,
                  {.row = row_of(experiment, values, " ", ", "),
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

void RunPool::start(std::size_t index, const PlannedRun& run, const std::filesystem::path& out) {
  const std::string said = (out / "said.txt").string();
  std::vector<std::string> words{program_.string()};
  words.insert(words.end(), run.arguments.begin(), run.arguments.end());
  words.insert(words.end(), {"--out", out.string()});
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) become(program_.c_str(), folder_.c_str(), said.c_str(), pointers.data(), parent);
  if (child < 0) throw StartupError(std::string("no process for a run: ") + std::strerror(errno), "give fewer --jobs");
  runs_[child] = index;
}

std::optional<RunPool::Ended> RunPool::ended() {
  int status = 0;
  const auto run = runs_.find(::waitpid(-1, &status, WNOHANG));
  if (run == runs_.end()) return std::nullopt;
  const Ended ended{run->second, status};
  runs_.erase(run);
  return ended;
}

std::vector<std::size_t> RunPool::kill_all() {
  std::vector<std::size_t> killed;
  for (const auto& [process, index] : runs_) {
    ::kill(process, SIGKILL);
    ::waitpid(process, nullptr, 0);
    killed.push_back(index);
  }
  runs_.clear();
  return killed;
}

}  // namespace jaywalk::campaign
