#include "apps/report/run_words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/report/csv_rows.h"
#include "apps/report/waits.h"
#include "firmware/recording/run_parts.h"
#include "hal/shown_text.h"
#include "hal/types/geometry.h"

namespace jaywalk {
namespace {

struct RunRow {
  double t_s = 0.0;
  Pose2 map_from_robot;  ///< as the controller believed
  bool stands = false;   ///< both wheels' commands are zero
  std::vector<std::string> reasons;
};

/// Of the columns that run_words() reads.
RunRow row_of(const CsvRows& rows) {
  const std::string& reasons = rows.text(6);
  return {rows.number(0),
          {rows.number(1), rows.number(2), rows.number(3)},
          rows.number(4) == 0.0 && rows.number(5) == 0.0,
          reasons.empty() ? std::vector<std::string>() : parts_between(reasons, '|')};
}

/// Why a robot stands: the first of these that its reasons hold. Faults go before limits.
struct Cause {
  const char* reason;
  const char* words;
};
constexpr const char* kNoGoal = "it had no goal";
constexpr std::array<Cause, 7> kCauses{{{"latched", "a fault waited for a reset"},
                                        {"no_goal", kNoGoal},
                                        {"touched", "something touched it, or its scanner saw itself"},
                                        {"stop_zone", "something stood in its way"},
                                        {"turn_blocked", "no room to turn to the goal's heading"},
                                        {"plan_stale", "no way was known"},
                                        {"unwatched", "it could not see where it would have gone"}}};
constexpr const char* kOwnWish = "it gave way or waited by its own choice";
/// Shorter rests are changes of direction.
constexpr double kShortestStop_s = 0.5;
/// Reasons that are limits, or say only that a fault is latched.
constexpr std::array kNoFaults{"stop_zone", "plan_stale", "speed_limit",  "latched",      "unwatched",
                               "no_goal",   "touched",    "turn_blocked", "not_recorded", "speed_zone"};

std::string often(int times) { return times == 1 ? "once" : std::to_string(times) + " times"; }

bool holds(const RunRow& row, const char* reason) {
  return std::find(row.reasons.begin(), row.reasons.end(), reason) != row.reasons.end();
}

std::string cause_of(const RunRow& row) {
  for (const Cause& cause : kCauses) {
    if (holds(row, cause.reason)) return cause.words;
  }
  return kOwnWish;
}

/// Everything that the words say, gathered row by row.
class Day {
 public:
  void add(const RunRow& row) {
    if (rows_ > 0) lived(row);
    if (rows_ == 0) begin_s_ = row.t_s;
    note_faults(row);
    before_ = row;
    ++rows_;
  }
  [[nodiscard]] double lasted_s() const { return before_.t_s - begin_s_; }
  /// Its last row was added.
  Waits& waits() { return end_stop(), waits_; }
  [[nodiscard]] std::string words() {
    end_stop();
    const double drove_s = before_.t_s - begin_s_ - stood_s_;
    std::string text = formatted("Drove %.1f m", way_m_) + formatted(" in %.1f s", std::max(drove_s, 0.0));
    if (drove_s > 0.0) text += formatted(" (%.2f m/s on average)", way_m_ / drove_s);
    text += formatted("; stood %.1f s.\n", stood_s_);
    for (const auto& [cause, stops] : stops_)
      text += formatted("  %7.1f s", stops.seconds) + ", " + often(stops.times) + ": " + cause + "\n";
    text += waits_.words();
    if (faults_.empty()) return text + "Faults: none.\n";
    text += "Faults:\n";
    for (const auto& [fault, times] : faults_) text += "  " + fault + ", " + often(times) + "\n";
    return text;
  }

 private:
  struct Stops {
    double seconds = 0.0;
    int times = 0;
  };

  void lived(const RunRow& row) {
    const double step_s = row.t_s - before_.t_s;
    const double step_m = distance(row.map_from_robot.position(), before_.map_from_robot.position());
    if (std::isfinite(step_m)) way_m_ += step_m;
    if (!before_.stands) return;
    if (in_stop_.empty()) stopped_ = before_;
    in_stop_[cause_of(before_)] += step_s;
    if (!row.stands) end_stop();
  }
  void end_stop() {
    double whole_s = 0.0;
    for (const auto& [cause, seconds] : in_stop_) whole_s += seconds;
    const auto main = std::max_element(in_stop_.begin(), in_stop_.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    if (main != in_stop_.end() && main->first != kNoGoal)
      waits_.add(stopped_.t_s, whole_s, stopped_.map_from_robot, main->first);
    if (whole_s >= kShortestStop_s) {
      stood_s_ += whole_s;
      for (const auto& [cause, seconds] : in_stop_) {
        stops_[cause].seconds += seconds;
        ++stops_[cause].times;
      }
    }
    in_stop_.clear();
  }
  void note_faults(const RunRow& row) {
    for (const std::string& reason : row.reasons) {
      const bool is_fault = std::find(kNoFaults.begin(), kNoFaults.end(), reason) == kNoFaults.end();
      if (is_fault && (rows_ == 0 || !holds(before_, reason.c_str()))) ++faults_[reason];
    }
  }

  std::size_t rows_ = 0;
  RunRow before_, stopped_;
  Waits waits_;
  double begin_s_ = 0.0, way_m_ = 0.0, stood_s_ = 0.0;
  std::map<std::string, double> in_stop_;  ///< seconds of the stop that goes on, by cause
  std::map<std::string, Stops> stops_;
  std::map<std::string, int> faults_;  ///< how often each began
};

/// The run's; no object where there is none.
nlohmann::json summary_of(const std::filesystem::path& folder) {
  std::ifstream in(folder / "summary.json");
  return nlohmann::json::parse(in, nullptr, false);
}

/// "reached after 40.2 s", or that it has no summary.
std::string outcome_of(const nlohmann::json& summary) {
  if (!summary.is_object() || !summary.contains("outcome") || !summary["outcome"].is_string())
    return "it left no summary: it was killed, or still runs";
  const std::string outcome = summary["outcome"].get<std::string>();
  if (!summary.contains("duration_s") || !summary["duration_s"].is_number()) return outcome;
  return outcome + formatted(" after %.1f s", summary["duration_s"].get<double>());
}

/// How long a person drove by the stick, and how much of the wish was granted; nothing where nobody did.
std::string steering_of(const nlohmann::json& summary) {
  const auto number = [&](const char* key) {
    return summary.is_object() && summary.contains(key) && summary[key].is_number() ? summary[key].get<double>() : 0.0;
  };
  const double steered_s = number("steered_s");
  if (steered_s <= 0.0) return "";
  return formatted("By the stick %.1f s", steered_s) +
         formatted(", by itself %.1f s", number("duration_s") - steered_s) +
         formatted("; %.0f %% of what the stick asked for was granted.\n", 100.0 * number("granted_share"));
}

/// When it drove loops; nothing where it drove none.
std::string loops_of(const nlohmann::json& summary) {
  if (!summary.is_object() || !summary.contains("loops_at_s") || !summary["loops_at_s"].is_array()) return "";
  std::string times;
  for (const auto& at : summary["loops_at_s"])
    if (at.is_number()) times += formatted(times.empty() ? "%.1f" : ", %.1f", at.get<double>());
  return times.empty() ? "" : "Full turns within 6 m of way that brought it no nearer, at " + times + " s.\n";
}

/// What can no longer be told, where the oldest parts of a run are gone.
std::string gone_of(int parts, const Day& day) {
  if (parts == 0) return "";
  return "Its first " + (parts == 1 ? "part is" : std::to_string(parts) + " parts are") + " gone; told are the last" +
         formatted(" %.1f s.\n", day.lasted_s());
}

void note_tracks(const std::filesystem::path& table, Waits& waits) {
  CsvRows rows(table, {"t_s", "id", "x_m", "y_m", "vx_mps", "vy_mps"});
  while (rows.next())
    waits.note(rows.number(0), static_cast<unsigned>(rows.number(1)), {rows.number(2), rows.number(3)},
               {rows.number(4), rows.number(5)});
}

}  // namespace

std::string run_words(const std::filesystem::path& folder) {
  const std::vector<std::filesystem::path> parts = parts_of(folder);
  Day day;
  for (const std::filesystem::path& place : parts.empty() ? std::vector{folder} : parts) {
    if (!parts.empty() && place == parts.back() && has_nothing(place / "robot.csv")) break;
    CsvRows rows(place / "robot.csv",
                 {"t_s", "est_x_m", "est_y_m", "est_heading_rad", "left_radps", "right_radps", "reasons"});
    while (rows.next()) day.add(row_of(rows));
  }
  for (const std::filesystem::path& place : parts.empty() ? std::vector{folder} : parts)
    if (day.waits().any() && !has_nothing(place / "tracks.csv")) note_tracks(place / "tracks.csv", day.waits());
  const nlohmann::json summary = summary_of(folder);
  const int before = parts.empty() ? 0 : part_number(parts.front()) - 1;
  return folder.string() + ": " + outcome_of(summary) + "\n" + gone_of(before, day) + day.words() + loops_of(summary) +
         (before > 0 && !steering_of(summary).empty() ? "Of the whole run: " : "") + steering_of(summary);
}

}  // namespace jaywalk
