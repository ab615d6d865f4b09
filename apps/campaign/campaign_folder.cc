#include "apps/campaign/campaign_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/campaign/plan_text.h"
#include "apps/campaign/ride.h"
#include "apps/campaign/statistics.h"
#include "hal/shown_text.h"
#include "hal/text_file.h"

namespace jaywalk::campaign {
namespace {

using Json = nlohmann::ordered_json;

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
  result.at_s = kUnknown;
  return result;
}

void add_figures(const Json& summary, const std::filesystem::path& folder, RunResult& result) {
  for (const auto& [name, value] : summary.items())
    if (value.is_number()) result.figures[name] = value.get<double>();
  result.turns = summary.at("turn_histogram").get<std::array<std::uint32_t, kTurnBins>>();
  const Ride ride = ride_of(folder / "robot.csv");
  result.figures["steering_reversals"] = ride.steering_reversals;
  result.figures["speed_reversals"] = ride.speed_reversals;
  result.figures["stood_share"] = ride.stood_share;
  result.figures["hard_brakes"] = ride.hard_brakes;
  result.figures["calm_jerk_p99_mps3"] = ride.calm_jerk_p99_mps3;
}

constexpr std::array kKeptOfAll{"run.json", "summary.json", "run.svg"};

/// The file lock that a process has until it ends, however it ends.
int hold(const std::filesystem::path& file, const std::string& share) {
  const int held = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (held < 0) throw StartupError(file.string() + ": cannot be written", "give --out a folder that can be written");
  if (::flock(held, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return held;  // not every disk has locks
  ::close(held);
  throw StartupError(file.parent_path().string() + ": another process runs its share " + share,
                     "wait for its end, or choose another --shard");
}

void make_folders(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw StartupError(folder.string() + ": " + error.message(), "give --out a folder that can be written");
}

void prune(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> others;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (std::find(kKeptOfAll.begin(), kKeptOfAll.end(), name) == kKeptOfAll.end()) others.push_back(entry.path());
  }
  for (const std::filesystem::path& other : others) std::filesystem::remove_all(other);
}

}  // namespace

double RunResult::figure(const std::string& name) const {
  const auto found = figures.find(name);
  return found == figures.end() ? kUnknown : found->second;
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
  result.at_s = kUnknown;
  add_figures(summary, folder, result);
  if (result.success) return result;
  const FailureWords words = failure_words(run, result.outcome, folder);
  result.reason = words.reason;
  result.at_s = words.at_s;
  return result;
}

std::string to_text(const RunResult& result) {
  Json j;
  j["outcome"] = result.outcome;
  j["success"] = result.success;
  j["reason"] = result.reason;
  j["at_s"] = result.at_s;  // null where there is none
  j["robot_csv"] = result.robot_csv;
  j["figures"] = result.figures;
  j["turn_histogram"] = result.turns;
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

std::filesystem::path place_of(const std::filesystem::path& campaign, const PlannedRun& run) {
  return campaign / "runs" / run.folder;
}

CampaignFolder::CampaignFolder(const std::filesystem::path& path, const std::string& text, const Shard& shard)
    : path_(path), share_(std::to_string(shard.part) + "-of-" + std::to_string(shard.of)) {
  make_folders(path_ / "shares");
  held_ = hold(path_ / "shares" / share_, share_);
  const std::filesystem::path plan = path_ / "campaign.json";
  if (!std::filesystem::exists(plan)) write_whole(plan, text, share_);
  if (text_in(plan) == text) return;
  ::close(held_);
  throw StartupError(path.string() + ": holds another campaign, or runs of other scenarios or of another build",
                     "choose another --out, or remove it");
}

CampaignFolder::~CampaignFolder() { ::close(held_); }

std::filesystem::path CampaignFolder::work(const PlannedRun& run) const {
  return place_of(path_, run).string() + ".part-" + share_;
}

bool CampaignFolder::is_finished(const PlannedRun& run) const {
  return std::filesystem::exists(place_of(path_, run) / "run.json");
}

RunResult CampaignFolder::result(const PlannedRun& run) const { return read_result(place_of(path_, run) / "run.json"); }

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
