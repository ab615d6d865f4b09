#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
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

/// A number of the summary; `otherwise` where it has none.
double number_of(const nlohmann::json& summary, const char* key, double otherwise = 0.0) {
  return summary.contains(key) && summary[key].is_number() ? summary[key].get<double>() : otherwise;
}

std::vector<double> numbers_of(const nlohmann::json& summary, const std::string& key) {
  std::vector<double> numbers;
  if (!summary.contains(key) || !summary[key].is_array()) return numbers;
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

constexpr double kFor_m = 3.0;  ///< a body farther off is no reason
constexpr double kWalks_mps = 0.2;
constexpr std::size_t kMostLines = 10;

/// A time that the robot was in one place, with the body that came nearest meanwhile.
struct Moment {
  double from_s, for_s;
  Vec2 where;             ///< in the map
  std::string what = {};  ///< in words, or empty
  double nearest_m = kFor_m;
  unsigned id = 0;
  double speed_mps = 0.0;

  /// A body as it was tracked; times in any order.
  void note(double t_s, unsigned body, Vec2 position_in_map, Vec2 velocity_in_map) {
    const double away = distance(position_in_map, where);
    if (t_s < from_s || t_s > from_s + for_s || away >= nearest_m) return;
    nearest_m = away, id = body, speed_mps = norm(velocity_in_map);
  }
  [[nodiscard]] std::string words() const {
    return formatted("  at %.1f s, %.1f, %.1f m", from_s, where.x, where.y) + formatted(", for %.1f s", for_s) +
           (what.empty() ? "" : ": " + what) +
           (id == 0 ? "; nobody was near\n"
                    : formatted("; body %u was %.1f m from its middle and %s\n", id, nearest_m,
                                speed_mps > kWalks_mps ? "walked" : "stood"));
  }
};

/// Moments of one kind, told below their title.
struct Told {
  const char* title;
  std::vector<Episode> episodes;  ///< the summary's, where it lists them
  std::size_t placed = 0;         ///< so many of them
  std::vector<Moment> moments = {};

  /// The longest of them, a line each; empty: there was none.
  [[nodiscard]] std::string words() const {
    std::vector<Moment> longest = moments;
    std::ranges::stable_sort(longest, std::greater(), &Moment::for_s);
    longest.resize(std::min(longest.size(), kMostLines));
    std::string text = longest.empty() ? "" : std::string(title) + "\n";
    for (const Moment& moment : longest) text += moment.words();
    if (moments.size() > kMostLines) text += "  and " + std::to_string(moments.size() - kMostLines) + " shorter\n";
    return text;
  }
};

/// Everything that the words say, gathered row by row.
class Day {
 public:
  explicit Day(const nlohmann::json& summary)
      : told_{{{"Its longest waits:", {}},
               {"Full turns within 10 m of way or 60 s:", episodes_of(summary, "loops")},
               {"Way of which more than a third brought it no nearer:", episodes_of(summary, "detours")}}} {}
  void add(const RunRow& row) {
    place_episodes(row);
    if (rows_ > 0) lived(row);
    if (rows_ == 0) begin_s_ = row.t_s;
    note_faults(row);
    before_ = row;
    ++rows_;
  }
  [[nodiscard]] double lasted_s() const { return before_.t_s - begin_s_; }
  /// After the last row: whether anything is told for which bodies are to be noted.
  [[nodiscard]] bool wants_bodies() {
    end_stop();
    return std::ranges::any_of(told_, [](const Told& told) { return !told.moments.empty(); });
  }
  /// Bodies as they were tracked.
  void note_bodies(const std::filesystem::path& tracks_csv) {
    CsvRows rows(tracks_csv, {"t_s", "id", "x_m", "y_m", "vx_mps", "vy_mps"});
    while (rows.next()) {
      for (Told& told : told_)
        for (Moment& moment : told.moments)
          moment.note(rows.number(0), static_cast<unsigned>(rows.number(1)), {rows.number(2), rows.number(3)},
                      {rows.number(4), rows.number(5)});
    }
  }
  [[nodiscard]] std::string words() {
    end_stop();
    const double drove_s = before_.t_s - begin_s_ - stood_s_;
    std::string text = formatted("Drove %.1f m", way_m_) + formatted(" in %.1f s", std::max(drove_s, 0.0));
    if (drove_s > 0.0) text += formatted(" (%.2f m/s on average)", way_m_ / drove_s);
    text += formatted("; stood %.1f s.\n", stood_s_);
    for (const auto& [cause, stops] : stops_)
      text += formatted("  %7.1f s", stops.seconds) + ", " + often(stops.times) + ": " + cause + "\n";
    for (const Told& told : told_) text += told.words();
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
    const auto main = std::ranges::max_element(in_stop_, {}, [](const auto& cause) { return cause.second; });
    if (main != in_stop_.end() && main->first != row_of(Reason::kNoGoal).says && whole_s >= kLeastWait_s)
      told_.front().moments.push_back({stopped_.t_s, whole_s, stopped_.map_from_robot.position(), main->first});
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
    for (Told& told : told_) {
      for (; told.placed < told.episodes.size(); ++told.placed) {
        const Episode& episode = told.episodes[told.placed];
        if (row.t_s < 0.5 * (episode.from_s + episode.to_s)) break;
        told.moments.push_back({episode.from_s, episode.to_s - episode.from_s, row.map_from_robot.position()});
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
  std::array<Told, 3> told_;  ///< waits first
  double begin_s_ = 0.0, way_m_ = 0.0, stood_s_ = 0.0;
  std::map<std::string, double> in_stop_;  ///< seconds of the stop that goes on, by cause
  std::map<std::string, Stops> stops_;
  std::map<std::string, int> faults_;  ///< how often each began
};

/// An empty object where there is none.
nlohmann::json object_in(const std::filesystem::path& file) {
  std::ifstream in(file);
  const nlohmann::json read = nlohmann::json::parse(in, nullptr, false);
  return read.is_object() ? read : nlohmann::json::object();
}

/// Last fault that a drive reported, as a line; empty without one.
std::string drive_fault_of(const nlohmann::json& devices) {
  const std::string fault = devices.value("drive_fault", "");
  return fault.empty() ? "" : "Its drives: " + fault + ".\n";
}

/// "reached after 40.2 s", or that it has no summary.
std::string outcome_of(const nlohmann::json& summary) {
  if (!summary.contains("outcome") || !summary["outcome"].is_string())
    return "it left no summary: it was killed, or still runs";
  const double duration_s = number_of(summary, "duration_s", std::nan(""));
  return summary["outcome"].get<std::string>() + (std::isnan(duration_s) ? "" : formatted(" after %.1f s", duration_s));
}

/// How long a person drove by the stick, and how much of the wish was granted; nothing where nobody did.
std::string steering_of(const nlohmann::json& summary) {
  const double steered_s = number_of(summary, "steered_s");
  if (steered_s <= 0.0) return "";
  return formatted("By the stick %.1f s", steered_s) +
         formatted(", by itself %.1f s", number_of(summary, "duration_s") - steered_s) +
         formatted("; %.0f %% of what the stick asked for was granted.\n", 100.0 * number_of(summary, "granted_share"));
}

/// What can no longer be told, where the oldest parts of a run are gone.
std::string gone_of(int parts, const Day& day) {
  if (parts == 0) return "";
  return "Its first " + (parts == 1 ? "part is" : std::to_string(parts) + " parts are") + " gone; told are the last" +
         formatted(" %.1f s.\n", day.lasted_s());
}

}  // namespace

std::string run_words(const std::filesystem::path& folder) {
  const std::vector<std::filesystem::path> parts = parts_of(folder),
                                           places = parts.empty() ? std::vector{folder} : parts;
  const nlohmann::json summary = object_in(folder / "summary.json");
  Day day(summary);
  for (const std::filesystem::path& place : places) {
    if (!parts.empty() && place == parts.back() && has_nothing(place / "robot.csv")) break;
    CsvRows rows(place / "robot.csv", {"t_s", "est_x_m", "est_y_m", "est_heading_rad", "permitted_v_mps", "left_radps",
                                       "right_radps", "reasons"});
    while (rows.next()) day.add(row_of(rows));
  }
  for (const std::filesystem::path& place : places)
    if (day.wants_bodies() && !has_nothing(place / "tracks.csv")) day.note_bodies(place / "tracks.csv");
  const std::string steering = steering_of(summary);
  const int before = parts.empty() ? 0 : part_number(parts.front()) - 1;
  return folder.string() + ": " + outcome_of(summary) + "\n" + gone_of(before, day) + day.words() +
         drive_fault_of(object_in(folder / "devices.json")) +
         (before > 0 && !steering.empty() ? "Of the whole run: " : "") + steering;
}

}  // namespace jaywalk
