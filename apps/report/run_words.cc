#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/report/csv_file.h"
#include "apps/report/drive_metrics.h"
#include "firmware/recording/run_folders.h"
#include "firmware/safety/reasons.h"
#include "hal/shown_text.h"
#include "hal/types/geometry.h"

namespace jaywalk {
namespace {
constexpr double kStands_mps = 0.05;  ///< as contacts that the robot causes (CONTRACT.md)

struct RunRow {
  double t_s = 0.0;
  Pose2 map_from_robot;  ///< as the controller believed
  bool stands = false;   ///< neither wheel is to roll at kStands_mps
  std::vector<std::string> reasons;
};

/// Whether the faster wheel is to roll slower than kStands_mps: the robot's speed is that of the wheels' mean.
bool stands(double permitted_mps, double left_radps, double right_radps) {
  if (left_radps == 0.0 && right_radps == 0.0) return true;
  const double faster = std::max(std::fabs(left_radps), std::fabs(right_radps));
  return std::fabs(permitted_mps) * faster < kStands_mps * std::fabs(0.5 * (left_radps + right_radps));
}

/// Of the columns that run_words() reads.
RunRow row_of(const CsvRows& rows) {
  const std::string& reasons = rows.text(7);
  return {rows.number(0),
          {rows.number(1), rows.number(2), rows.number(3)},
          stands(rows.number(4), rows.number(5), rows.number(6)),
          reasons.empty() ? std::vector<std::string>() : parts_between(reasons, '|')};
}

/// Why a robot stands: the first of these that its reasons hold. Faults go before limits.
constexpr std::array kCauses{Reason::kLatched,     Reason::kNoGoal,    Reason::kTouched,  Reason::kStopZone,
                             Reason::kTurnBlocked, Reason::kPlanStale, Reason::kUnwatched};
constexpr const char* kOwnWish = "it gives way or waits by its own choice";
/// Shorter rests are changes of direction.
constexpr double kShortestStop_s = 0.5;
constexpr double kLeastWait_s = 3.0;  ///< of a stop that is told by itself

std::string often(int times) { return times == 1 ? "once" : std::to_string(times) + " times"; }

bool holds(const RunRow& row, const char* reason) {
  return std::find(row.reasons.begin(), row.reasons.end(), reason) != row.reasons.end();
}

std::string cause_of(const RunRow& row) {
  for (const Reason cause : kCauses) {
    if (holds(row, row_of(cause).name)) return row_of(cause).says;
  }
  return kOwnWish;
}

/// A kind of episode that the summary lists, and what it is called.
struct Told {
  const char* key;
  const char* title;
};
constexpr std::array<Told, 2> kTold{{{"loops", "Full turns within 10 m of way or 60 s:"},
                                     {"detours", "Way of which more than a third brought it no nearer:"}}};

std::vector<double> numbers_of(const nlohmann::json& summary, const std::string& key) {
  std::vector<double> numbers;
  if (!summary.is_object() || !summary.contains(key) || !summary[key].is_array()) return numbers;
  for (const auto& number : summary[key]) numbers.push_back(number.is_number() ? number.get<double>() : 0.0);
  return numbers;
}

std::vector<Episode> episodes_of(const nlohmann::json& summary, const std::string& key) {
  const std::vector<double> at_s = numbers_of(summary, key + "_at_s"), for_s = numbers_of(summary, key + "_for_s");
  std::vector<Episode> episodes;
  for (std::size_t k = 0; k < std::min(at_s.size(), for_s.size()); ++k)
    episodes.push_back({at_s[k], at_s[k] + for_s[k]});
  return episodes;
}

/// Everything that the words say, gathered row by row.
class Day {
 public:
  explicit Day(const nlohmann::json& summary) {
    for (std::size_t k = 0; k < kTold.size(); ++k) episodes_[k] = episodes_of(summary, kTold[k].key);
  }
  void add(const RunRow& row) {
    place_episodes(row);
    if (rows_ > 0) lived(row);
    if (rows_ == 0) begin_s_ = row.t_s;
    note_faults(row);
    before_ = row;
    ++rows_;
  }
  [[nodiscard]] double lasted_s() const { return before_.t_s - begin_s_; }
  /// Bodies as they were tracked, after the last row.
  template <class Visit>
  void note_bodies(const Visit& each_table) {
    end_stop();
    if (waits_.any() || told_[0].any() || told_[1].any())
      each_table([this](auto... body) {
        waits_.note(body...);
        for (Moments& told : told_) told.note(body...);
      });
  }
  [[nodiscard]] std::string words() {
    end_stop();
    const double drove_s = before_.t_s - begin_s_ - stood_s_;
    std::string text = formatted("Drove %.1f m", way_m_) + formatted(" in %.1f s", std::max(drove_s, 0.0));
    if (drove_s > 0.0) text += formatted(" (%.2f m/s on average)", way_m_ / drove_s);
    text += formatted("; stood %.1f s.\n", stood_s_);
    for (const auto& [cause, stops] : stops_)
      text += formatted("  %7.1f s", stops.seconds) + ", " + often(stops.times) + ": " + cause + "\n";
    text += waits_.words("Its longest waits:");
    for (std::size_t k = 0; k < kTold.size(); ++k) text += told_[k].words(kTold[k].title);
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
    if (main != in_stop_.end() && main->first != row_of(Reason::kNoGoal).says && whole_s >= kLeastWait_s)
      waits_.add(stopped_.t_s, whole_s, stopped_.map_from_robot.position(), main->first);
    if (whole_s >= kShortestStop_s) {
      stood_s_ += whole_s;
      for (const auto& [cause, seconds] : in_stop_) {
        stops_[cause].seconds += seconds;
        ++stops_[cause].times;
      }
    }
    in_stop_.clear();
  }
  /// An episode is where the robot was in its middle.
  void place_episodes(const RunRow& row) {
    for (std::size_t k = 0; k < kTold.size(); ++k) {
      for (; placed_[k] < episodes_[k].size(); ++placed_[k]) {
        const Episode& episode = episodes_[k][placed_[k]];
        if (row.t_s < 0.5 * (episode.from_s + episode.to_s)) break;
        told_[k].add(episode.from_s, episode.to_s - episode.from_s, row.map_from_robot.position(), "");
      }
    }
  }
  void note_faults(const RunRow& row) {
    for (const std::string& reason : row.reasons) {
      if (!has(kNoFaults, reason_named(reason)) && (rows_ == 0 || !holds(before_, reason.c_str()))) ++faults_[reason];
    }
  }

  std::size_t rows_ = 0;
  RunRow before_, stopped_;
  Moments waits_;
  std::array<std::vector<Episode>, kTold.size()> episodes_;
  std::array<std::size_t, kTold.size()> placed_{};  ///< so many of them
  std::array<Moments, kTold.size()> told_;
  double begin_s_ = 0.0, way_m_ = 0.0, stood_s_ = 0.0;
  std::map<std::string, double> in_stop_;  ///< seconds of the stop that goes on, by cause
  std::map<std::string, Stops> stops_;
  std::map<std::string, int> faults_;  ///< how often each began
};

/// No object where there is none.
nlohmann::json json_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return nlohmann::json::parse(in, nullptr, false);
}

/// Last fault that a drive reported, as a line; empty without one.
std::string drive_fault_of(const nlohmann::json& devices) {
  const std::string fault = devices.is_object() ? devices.value("drive_fault", "") : "";
  return fault.empty() ? "" : "Its drives: " + fault + ".\n";
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

/// What can no longer be told, where the oldest parts of a run are gone.
std::string gone_of(int parts, const Day& day) {
  if (parts == 0) return "";
  return "Its first " + (parts == 1 ? "part is" : std::to_string(parts) + " parts are") + " gone; told are the last" +
         formatted(" %.1f s.\n", day.lasted_s());
}

template <class Note>
void note_tracks(const std::filesystem::path& table, const Note& note) {
  CsvRows rows(table, {"t_s", "id", "x_m", "y_m", "vx_mps", "vy_mps"});
  while (rows.next())
    note(rows.number(0), static_cast<unsigned>(rows.number(1)), Vec2{rows.number(2), rows.number(3)},
         Vec2{rows.number(4), rows.number(5)});
}

}  // namespace

std::string run_words(const std::filesystem::path& folder) {
  const std::vector<std::filesystem::path> parts = parts_of(folder);
  const nlohmann::json summary = json_of(folder / "summary.json");
  Day day(summary);
  for (const std::filesystem::path& place : parts.empty() ? std::vector{folder} : parts) {
    if (!parts.empty() && place == parts.back() && has_nothing(place / "robot.csv")) break;
    CsvRows rows(place / "robot.csv", {"t_s", "est_x_m", "est_y_m", "est_heading_rad", "permitted_v_mps", "left_radps",
                                       "right_radps", "reasons"});
    while (rows.next()) day.add(row_of(rows));
  }
  day.note_bodies([&](const auto& note) {
    for (const std::filesystem::path& place : parts.empty() ? std::vector{folder} : parts)
      if (!has_nothing(place / "tracks.csv")) note_tracks(place / "tracks.csv", note);
  });
  const int before = parts.empty() ? 0 : part_number(parts.front()) - 1;
  return folder.string() + ": " + outcome_of(summary) + "\n" + gone_of(before, day) + day.words() +
         drive_fault_of(json_of(folder / "devices.json")) +
         (before > 0 && !steering_of(summary).empty() ? "Of the whole run: " : "") + steering_of(summary);
}

}  // namespace jaywalk
