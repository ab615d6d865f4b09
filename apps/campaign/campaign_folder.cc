#include "apps/campaign/campaign_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <cinttypes>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "hal/shown_text.h"
#include "hal/text_file.h"
#include "hal/types/errors.h"

namespace jaywalk::campaign {

// Fields of these structs in campaign.json, by name (nlohmann::json).
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlannedRun, row, values, scenario, seed, folder, cruise_mps, command)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ReportedExperiment, name, title, axes, scenarios, runs)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ReportedCampaign, title, program, experiments)

namespace {

using Json = nlohmann::ordered_json;

std::string digest_of(const std::set<std::filesystem::path>& inputs) {
  std::multiset<std::string> all;  // in the order of names: folders may be called otherwise elsewhere
  for (const std::filesystem::path& input : inputs) all.insert(input.filename().string() + digest_of_file(input));
  std::string text;
  for (const std::string& one : all) text += one + "\n";
  return digest_of_text(text);
}

Json json_of(const PlannedRun& run) {
  return {{"row", run.row},       {"values", run.values},         {"scenario", run.scenario}, {"seed", run.seed},
          {"folder", run.folder}, {"cruise_mps", run.cruise_mps}, {"command", run.command}};
}

Json json_of(const Experiment& experiment, const std::vector<PlannedRun>& all) {
  std::vector<std::string> axes, scenarios;
  for (const Axis& axis : experiment.axes) axes.push_back(axis.name);
  Json runs = Json::array();
  for (const PlannedRun& run : all) {
    if (!run.folder.starts_with(experiment.name + "/")) continue;
    runs.push_back(json_of(run));
    if (std::ranges::count(scenarios, run.scenario) == 0) scenarios.push_back(run.scenario);
  }
  return {
      {"name", experiment.name}, {"title", experiment.title}, {"axes", axes}, {"scenarios", scenarios}, {"runs", runs}};
}

constexpr std::uint64_t kOffset = 0xcbf29ce484222325U, kPrime = 0x100000001b3U;

std::uint64_t mixed(std::uint64_t hash, std::string_view bytes) {
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * kPrime;
  return hash;
}

std::string hexadecimal(std::uint64_t hash) { return formatted("%016" PRIx64, hash); }

/// The program's last error line, without the path of the run's folder: that path differs between shards.
std::string last_words(const std::filesystem::path& folder) {
  const std::string said = text_in(folder / "said.txt"), own = folder.string();
  const std::size_t begin = said.rfind("jaywalk: ");
  if (begin == std::string::npos) return "it said nothing";
  std::string line = said.substr(begin + 9, said.find('\n', begin) - begin - 9);
  for (std::size_t at = line.find(own); at != std::string::npos; at = line.find(own))
    line.replace(at, own.size(), "OUT");
  return printable(line);
}

RunResult without_run(const std::filesystem::path& folder, const std::string& outcome, const std::string& how) {
  RunResult result;
  result.outcome = outcome;
  result.reason = how + ": " + last_words(folder);
  return result;
}

constexpr std::array kKeptOfAll{"run.json", "summary.json", "run.svg"};

/// The file lock that a process has until it ends, however it ends.
wire::FileDescriptor hold(const std::filesystem::path& file, const std::string& share) {
  wire::FileDescriptor held(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644));
  if (held.get() < 0)
    throw StartupError(file.string() + ": cannot be written", "give --out a folder that can be written");
  if (::flock(held.get(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return held;  // not every disk has locks
  throw StartupError(file.parent_path().string() + ": another process runs its share " + share,
                     "wait for its end, or choose another --shard");
}

void make_folders(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw StartupError(folder.string() + ": " + error.message(), "give --out a folder that can be written");
}

void prune(const std::filesystem::path& folder) {
  const std::vector<std::filesystem::path> all(std::filesystem::directory_iterator(folder), {});
  for (const std::filesystem::path& file : all)
    if (std::ranges::count(kKeptOfAll, file.filename()) == 0) std::filesystem::remove_all(file);
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
    return nlohmann::json::parse(in).get<ReportedCampaign>();
  } catch (const nlohmann::json::exception&) {
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

RunResult result_of(const PlannedRun& run, const std::filesystem::path& folder, int status) {
  if (WIFSIGNALED(status)) return without_run(folder, "crashed", "ended by signal " + std::to_string(WTERMSIG(status)));
  const int code = WEXITSTATUS(status);
  const Json summary = Json::parse(text_in(folder / "summary.json"), nullptr, false);
  if (code == 2) return without_run(folder, "refused", "exit code 2");
  if (code > 1 || !summary.is_object()) return without_run(folder, "crashed", "exit code " + std::to_string(code));
  RunResult result;
  result.outcome = summary.at("outcome").get<std::string>();
  result.success = summary.at("success").get<bool>();
  result.robot_csv = digest_of_file(folder / "robot.csv");
  for (const auto& [name, value] : summary.items())
    if (value.is_number()) result.figures[name] = value.get<double>();
  result.turns = summary.at("turn_histogram").get<std::array<std::uint32_t, kTurnBins>>();
  result.figures.merge(ride_of(folder / "robot.csv"));
  if (result.success) return result;
  std::tie(result.at_s, result.reason) = failure_words(run, result.outcome, folder);
  return result;
}

std::string to_text(const RunResult& result) {
  const Json j{{"outcome", result.outcome},     {"success", result.success}, {"reason", result.reason},
               {"at_s", result.at_s},  // null where there is none
               {"robot_csv", result.robot_csv}, {"figures", result.figures}, {"turn_histogram", result.turns}};
  return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

RunResult read_result(const std::filesystem::path& file) {
  try {
    const Json j = Json::parse(text_in(file));
    RunResult result;
    result.outcome = j.at("outcome").get<std::string>();
    result.success = j.at("success").get<bool>();
    result.reason = j.at("reason").get<std::string>();
    result.at_s = j.at("at_s").is_null() ? kUnknown : j.at("at_s").get<double>();
    result.robot_csv = j.at("robot_csv").get<std::string>();
    for (const auto& [name, value] : j.at("figures").items())
      result.figures[name] = value.is_null() ? kUnknown : value.get<double>();
    result.turns = j.at("turn_histogram").get<std::array<std::uint32_t, kTurnBins>>();
    return result;
  } catch (const Json::exception&) {
    throw StartupError(file.string() + ": is no run.json of this program",
                       "remove its folder and run the campaign again");
  }
}

void write_whole(const std::filesystem::path& file, const std::string& text, const std::string& own_name) {
  const std::filesystem::path begun = file.string() + "." + own_name;
  std::ofstream out(begun, std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(begun, file, error);
  if (!out || error) throw StartupError(file.string() + ": cannot be written", "free some disk and call this again");
}

CampaignFolder::CampaignFolder(const std::filesystem::path& path, const std::string& text, const Shard& shard)
    : path_(path), share_(std::to_string(shard.part) + "-of-" + std::to_string(shard.of)) {
  make_folders(path_ / "shares");
  held_ = hold(path_ / "shares" / share_, share_);
  const std::filesystem::path plan = path_ / "campaign.json";
  if (!std::filesystem::exists(plan)) write_whole(plan, text, share_);
  if (text_in(plan) == text) return;
  throw StartupError(path.string() + ": holds another campaign, or runs of other scenarios or of another build",
                     "choose another --out, or remove it");
}

std::filesystem::path CampaignFolder::begin(const PlannedRun& run) const {
  drop(run);
  make_folders(work(run));
  return work(run);
}

void CampaignFolder::drop(const PlannedRun& run) const {
  std::error_code ignored;
  std::filesystem::remove_all(work(run), ignored);
}

void CampaignFolder::finish(const PlannedRun& run, const RunResult& result, Keep keep) const {
  if (keep == Keep::kFigures || (keep == Keep::kFailures && result.success)) prune(work(run));
  write_whole(work(run) / "run.json", to_text(result), share_);
  std::error_code error;
  std::filesystem::rename(work(run), place_of(path_, run), error);
  if (!error) return;
  if (!is_finished(run)) throw StartupError(place_of(path_, run).string() + ": " + error.message(), "remove it");
  drop(run);  // another division of the campaign finished it, with the same result
}

}  // namespace jaywalk::campaign
