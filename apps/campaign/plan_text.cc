#include "apps/campaign/plan_text.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>

#include "hal/types/errors.h"

namespace jaywalk::campaign {
namespace {

using Json = nlohmann::ordered_json;

std::string digest_of(const std::set<std::filesystem::path>& inputs) {
  std::vector<std::string> all;
  for (const std::filesystem::path& input : inputs) all.push_back(input.filename().string() + digest_of_file(input));
  std::sort(all.begin(), all.end());  // folders may be called otherwise elsewhere
  std::string text;
  for (const std::string& one : all) text += one + "\n";
  return digest_of_text(text);
}

Json json_of(const PlannedRun& run) {
  return {{"row", run.row},       {"values", run.values},         {"scenario", run.scenario},  {"seed", run.seed},
          {"folder", run.folder}, {"cruise_mps", run.cruise_mps}, {"command", command_of(run)}};
}

Json json_of(const Experiment& experiment, const std::vector<PlannedRun>& all) {
  std::vector<std::string> axes, scenarios;
  for (const Axis& axis : experiment.axes) axes.push_back(axis.name);
  Json runs = Json::array();
  for (const PlannedRun& run : all) {
    if (run.experiment != experiment.name) continue;
    runs.push_back(json_of(run));
    if (std::find(scenarios.begin(), scenarios.end(), run.scenario) == scenarios.end())
      scenarios.push_back(run.scenario);
  }
  return {
      {"name", experiment.name}, {"title", experiment.title}, {"axes", axes}, {"scenarios", scenarios}, {"runs", runs}};
}

void read_run(const Json& j, ReportedExperiment& experiment) {
  PlannedRun run;
  run.experiment = experiment.name;
  run.row = j.at("row").get<std::string>();
  run.values = j.at("values").get<std::vector<std::string>>();
  run.scenario = j.at("scenario").get<std::string>();
  run.seed = j.at("seed").get<std::uint64_t>();
  run.folder = j.at("folder").get<std::string>();
  run.cruise_mps = j.at("cruise_mps").get<double>();
  experiment.runs.push_back(std::move(run));
  experiment.commands.push_back(j.at("command").get<std::string>());
}

ReportedExperiment read_experiment(const Json& j) {
  ReportedExperiment experiment;
  experiment.name = j.at("name").get<std::string>();
  experiment.title = j.at("title").get<std::string>();
  experiment.axes = j.at("axes").get<std::vector<std::string>>();
  experiment.scenarios = j.at("scenarios").get<std::vector<std::string>>();
  for (const Json& run : j.at("runs")) read_run(run, experiment);
  return experiment;
}

constexpr std::uint64_t kOffset = 0xcbf29ce484222325U, kPrime = 0x100000001b3U;

std::uint64_t mixed(std::uint64_t hash, std::string_view bytes) {
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * kPrime;
  return hash;
}

std::string hexadecimal(std::uint64_t hash) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text(16, '0');
  for (std::size_t k = 16; k-- > 0; hash /= 16U) text[k] = kDigits[hash % 16U];
  return text;
}

}  // namespace

std::string plan_text(const Campaign& campaign, const Plan& plan, const std::filesystem::path& program) {
  Json j;
  j["title"] = campaign.title;
  j["program"] = std::string("jaywalk ") + JAYWALK_VERSION + ", file " + digest_of_file(program);
  j["inputs"] = digest_of(plan.inputs);
  j["experiments"] = Json::array();
  for (const Experiment& experiment : campaign.experiments) j["experiments"].push_back(json_of(experiment, plan.runs));
  return j.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

ReportedCampaign read_plan(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  try {
    const Json j = Json::parse(in);
    ReportedCampaign campaign;
    campaign.title = j.at("title").get<std::string>();
    campaign.program = j.at("program").get<std::string>();
    for (const Json& experiment : j.at("experiments")) campaign.experiments.push_back(read_experiment(experiment));
    return campaign;
  } catch (const Json::exception&) {
    throw StartupError(file.string() + ": is no campaign.json of this program", "give the folder of a campaign");
  }
}

std::string digest_of_text(std::string_view text) { return hexadecimal(mixed(kOffset, text)); }

std::string digest_of_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::array<char, 1U << 16U> block{};
  std::uint64_t hash = kOffset;
  while (in.read(block.data(), block.size()) || in.gcount() > 0)
    hash = mixed(hash, {block.data(), static_cast<std::size_t>(in.gcount())});
  return hexadecimal(hash);
}

}  // namespace jaywalk::campaign
