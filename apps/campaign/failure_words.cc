#include "apps/campaign/failure_words.h"

#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "apps/report/csv_file.h"
#include "hal/shown_text.h"

namespace jaywalk::campaign {
namespace {

constexpr double kStands_mps = 0.02;

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
  const RobotRow* found = &rows.front();
  for (const RobotRow& row : rows) {
    if (row.t_s <= t_s) found = &row;
  }
  return *found;
}

std::string where(const RobotRow& row) {
  return formatted("the robot, at %.2f m/s at (%.1f, %.1f)", row.v_mps, row.position.x, row.position.y);
}

/// The first mover that the robot made to turn.
FailureWords forced_words(const std::filesystem::path& folder, const std::vector<RobotRow>& robot) {
  CsvRows rows(folder / "movers.csv", {"t_s", "id", "x_m", "y_m", "forced"});
  FailureWords words{std::numeric_limits<double>::quiet_NaN(), ""};
  std::set<std::string> forced;
  while (rows.next()) {
    if (rows.text(4) != "1") continue;
    if (forced.empty()) {
      words.at_s = rows.number(0);
      const RobotRow& then = row_at(robot, words.at_s);
      const double apart_m = distance(then.position, {rows.number(2), rows.number(3)});
      words.reason = "mover " + rows.text(1) + " had to turn for " + where(then) + formatted(", %.2f m apart", apart_m);
    }
    forced.insert(rows.text(1));
  }
  if (forced.size() > 1) words.reason += "; " + std::to_string(forced.size()) + " movers in all";
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

FailureWords timeout_words(const PlannedRun& run, const std::vector<RobotRow>& robot) {
  const RobotRow& end = robot.back();
  double moved_s = robot.front().t_s;
  for (const RobotRow& row : robot) {
    if (std::fabs(row.v_mps) > kStands_mps) moved_s = row.t_s;
  }
  std::string reason = "time was over " + formatted("%.1f m from the goal", distance(end.position, run.goal)) +
                       " for " + where(end) + formatted(", which had stood for %.1f s", end.t_s - moved_s);
  if (!end.reasons.empty()) reason += " (" + end.reasons + ")";
  return {moved_s, reason};
}

/// The last tick is after the contact, which stops the robot; the tick before has the speed at contact.
FailureWords collision_words(const std::filesystem::path& folder, const std::vector<RobotRow>& robot) {
  const RobotRow& end = robot.back();
  RobotRow touched = end;
  if (robot.size() > 1) touched.v_mps = robot[robot.size() - 2].v_mps;
  return {end.t_s, "something touched " + where(touched) + ", " + nearest_mover(folder, end)};
}

FailureWords fault_words(const std::vector<RobotRow>& robot) {
  for (const RobotRow& row : robot) {
    if (row.reasons.find("latched") != std::string::npos)
      return {row.t_s, "a fault stopped " + where(row) + ": " + row.reasons};
  }
  return {robot.back().t_s, "a fault stopped " + where(robot.back())};
}

}  // namespace

FailureWords failure_words(const PlannedRun& run, const std::string& outcome, const std::filesystem::path& folder) {
  const std::vector<RobotRow> robot = robot_rows(folder);
  if (robot.empty()) return {std::numeric_limits<double>::quiet_NaN(), "it left no tick"};
  if (outcome == "forced_mover") return forced_words(folder, robot);
  if (outcome == "fault") return fault_words(robot);
  if (outcome != "collision") return timeout_words(run, robot);
  return collision_words(folder, robot);
}

}  // namespace jaywalk::campaign
