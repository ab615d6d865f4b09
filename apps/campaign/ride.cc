#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "apps/campaign/campaign_folder.h"
#include "apps/report/csv_file.h"
#include "apps/report/distribution.h"
#include "hal/shown_text.h"

namespace jaywalk::campaign {
namespace {

constexpr double kLeastTurn_radps = 0.1, kLeastSpeed_mps = 0.03;  // slower than this it turns, or drives, neither way
constexpr double kStands_mps = 0.05;
/// Above every model's comfort and below every model's braking; changes are taken over 0.1 s, as Smoothness does.
constexpr double kHardBrake_mps2 = 0.7;
constexpr double kChangeOver_s = 0.0999, kBrakeEnds_s = 0.3;  // a brake that bites again sooner is the same
constexpr double kBesideBrake_s = 0.25;                       // its onset and release are its own

/// How often a value larger than `least` is followed, at last, by one of the other sign.
double reversals(const std::vector<double>& values, double least) {
  double count = 0.0;
  int sign = 0;
  for (const double value : values) {
    if (!(std::fabs(value) > least)) continue;
    const int now = value > 0.0 ? 1 : -1;
    if (now == -sign) ++count;
    sign = now;
  }
  return count;
}

/// Hard brakes, and the jerk apart from them.
class Brakes {
 public:
  void add(double t_s, double v_mps) {
    while (first_ + 1 < samples_.size() && t_s - samples_[first_ + 1].t_s >= kChangeOver_s) ++first_;
    Sample now{t_s, std::fabs(v_mps)};
    if (!samples_.empty() && t_s - samples_[first_].t_s >= kChangeOver_s) {
      const Sample& before = samples_[first_];
      now.accel = (now.speed - before.speed) / (t_s - before.t_s);
      now.jerk = std::fabs(now.accel - before.accel) / (t_s - before.t_s);
      if (now.accel < -kHardBrake_mps2) note_brake(t_s);
    }
    samples_.push_back(now);
  }
  [[nodiscard]] double count() const { return static_cast<double>(brakes_.size()); }
  [[nodiscard]] double calm_jerk(double share) const {
    Distribution calm;
    for (const Sample& sample : samples_)
      if (!std::isnan(sample.jerk) && !is_beside_brake(sample.t_s)) calm.add(sample.jerk);
    return calm.quantile(share);
  }

 private:
  struct Sample {
    double t_s, speed, accel = std::nan(""), jerk = std::nan("");
  };
  void note_brake(double t_s) {
    if (brakes_.empty() || t_s - brakes_.back().second > kBrakeEnds_s) brakes_.emplace_back(t_s, t_s);
    brakes_.back().second = t_s;
  }
  [[nodiscard]] bool is_beside_brake(double t_s) const {
    return std::ranges::any_of(brakes_, [t_s](const auto& brake) {
      return t_s > brake.first - kBesideBrake_s && t_s < brake.second + kBesideBrake_s;
    });
  }

  std::vector<Sample> samples_;
  std::size_t first_ = 0;                            ///< the youngest at least kChangeOver_s old
  std::vector<std::pair<double, double>> brakes_{};  ///< from, to, s
};

constexpr double kStuck_mps = 0.02;

using Failure = std::pair<double, std::string>;  ///< its moment, s, and reason

struct RobotRow {
  double t_s = 0.0;
  Vec2 position;
  double v_mps = 0.0;
  std::string reasons;
};

std::vector<RobotRow> robot_rows(const std::filesystem::path& folder) {
  CsvRows rows(folder / "robot.csv", {"t_s", "x_m", "y_m", "v_mps", "reasons"});
  std::vector<RobotRow> all;
  while (rows.next()) all.push_back({rows.number(0), {rows.number(1), rows.number(2)}, rows.number(3), rows.text(4)});
  return all;
}

const RobotRow& row_at(const std::vector<RobotRow>& rows, double t_s) {
  const auto after = std::ranges::upper_bound(rows.begin() + 1, rows.end(), t_s, {}, &RobotRow::t_s);
  return *(after - 1);
}

std::string where(const RobotRow& row) {
  return formatted("the robot, at %.2f m/s at (%.1f, %.1f)", row.v_mps, row.position.x, row.position.y);
}

/// The first mover that the robot made to turn.
Failure forced_words(const std::filesystem::path& folder, const std::vector<RobotRow>& robot) {
  CsvRows rows(folder / "movers.csv", {"t_s", "id", "x_m", "y_m", "forced"});
  Failure words{kUnknown, ""};
  std::set<std::string> forced;
  while (rows.next()) {
    if (rows.text(4) != "1") continue;
    if (forced.empty()) {
      words.first = rows.number(0);
      const RobotRow& then = row_at(robot, words.first);
      const double apart_m = distance(then.position, {rows.number(2), rows.number(3)});
      words.second = "mover " + rows.text(1) + " had to turn for " + where(then) + formatted(", %.2f m apart", apart_m);
    }
    forced.insert(rows.text(1));
  }
  if (forced.size() > 1) words.second += "; " + std::to_string(forced.size()) + " movers in all";
  return words;
}

/// The mover nearest to the robot at the end of the run, by their centres.
std::string nearest_mover(const std::filesystem::path& folder, const RobotRow& end) {
  CsvRows rows(folder / "movers.csv", {"t_s", "id", "x_m", "y_m"});
  std::string nearest;
  double least_m = std::numeric_limits<double>::infinity();
  while (rows.next()) {
    if (rows.number(0) < end.t_s) continue;
    const double apart_m = distance(end.position, {rows.number(2), rows.number(3)});
    if (apart_m < least_m) least_m = apart_m, nearest = rows.text(1);
  }
  return nearest.empty() ? "nobody about" : formatted("mover %s nearest, %.2f m off", nearest.c_str(), least_m);
}

Failure timeout_words(const PlannedRun& run, const std::vector<RobotRow>& robot) {
  const RobotRow& end = robot.back();
  double moved_s = robot.front().t_s;
  for (const RobotRow& row : robot)
    if (std::fabs(row.v_mps) > kStuck_mps) moved_s = row.t_s;
  std::string reason = "time was over " + formatted("%.1f m from the goal", distance(end.position, run.goal)) +
                       " for " + where(end) + formatted(", which had stood for %.1f s", end.t_s - moved_s);
  if (!end.reasons.empty()) reason += " (" + end.reasons + ")";
  return {moved_s, reason};
}

/// The last tick is after the contact, which stops the robot; the tick before has the speed at contact.
Failure collision_words(const std::filesystem::path& folder, const std::vector<RobotRow>& robot) {
  const RobotRow& end = robot.back();
  RobotRow touched = end;
  if (robot.size() > 1) touched.v_mps = robot[robot.size() - 2].v_mps;
  return {end.t_s, "something touched " + where(touched) + ", " + nearest_mover(folder, end)};
}

Failure fault_words(const std::vector<RobotRow>& robot) {
  for (const RobotRow& row : robot)
    if (row.reasons.find("latched") != std::string::npos)
      return {row.t_s, "a fault stopped " + where(row) + ": " + row.reasons};
  return {robot.back().t_s, "a fault stopped " + where(robot.back())};
}

}  // namespace

std::map<std::string, double> ride_of(const std::filesystem::path& robot_csv) {
  CsvRows rows(robot_csv, {"v_mps", "w_radps", "t_s"});
  std::vector<double> v_mps, w_radps;
  Brakes brakes;
  while (rows.next()) {
    v_mps.push_back(rows.number(0));
    w_radps.push_back(rows.number(1));
    brakes.add(rows.number(2), v_mps.back());
  }
  const auto ticks = static_cast<double>(v_mps.size());
  const auto stood = std::ranges::count_if(v_mps, [](double v) { return std::fabs(v) < kStands_mps; });
  return {{"steering_reversals", reversals(w_radps, kLeastTurn_radps)},
          {"speed_reversals", reversals(v_mps, kLeastSpeed_mps)},
          {"stood_share", ticks > 0.0 ? static_cast<double>(stood) / ticks : 0.0},
          {"hard_brakes", brakes.count()},
          {"calm_jerk_p99_mps3", brakes.calm_jerk(0.99)}};
}

Failure failure_words(const PlannedRun& run, const std::string& outcome, const std::filesystem::path& folder) {
  const std::vector<RobotRow> robot = robot_rows(folder);
  if (robot.empty()) return {kUnknown, "it left no tick"};
  if (outcome == "forced_mover") return forced_words(folder, robot);
  if (outcome == "fault") return fault_words(robot);
  if (outcome != "collision") return timeout_words(run, robot);
  return collision_words(folder, robot);
}

}  // namespace jaywalk::campaign
