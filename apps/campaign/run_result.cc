#include "apps/campaign/run_result.h"

#include <sys/wait.h>

#include <nlohmann/json.hpp>

#include "apps/campaign/plan_text.h"
#include "apps/campaign/ride.h"
#include "apps/campaign/statistics.h"
#include "hal/shown_text.h"
#include "hal/text_file.h"

namespace jaywalk::campaign {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::array kFigures{"path_length_m",   "static_shortest_path_m", "duration_s",
                              "min_clearance_m", "min_mover_clearance_m",  "forced_movers",
                              "contacts",        "contacts_caused",        "max_turn_deg",
                              "loops",           "accel_max_mps2",         "jerk_p99_mps3",
                              "jerk_max_mps3",   "granted_share",          "detour_m"};

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
  for (const char* name : kFigures) {
    if (summary.contains(name) && summary[name].is_number()) result.figures[name] = summary[name].get<double>();
  }
  result.turns = summary.at("turn_histogram").get<std::array<std::uint32_t, kTurnBins>>();
  const Ride ride = ride_of(folder / "robot.csv");
  result.figures["steering_reversals"] = ride.steering_reversals;
  result.figures["speed_reversals"] = ride.speed_reversals;
  result.figures["stood_share"] = ride.stood_share;
  result.figures["hard_brakes"] = ride.hard_brakes;
  result.figures["calm_jerk_p99_mps3"] = ride.calm_jerk_p99_mps3;
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

}  // namespace jaywalk::campaign
