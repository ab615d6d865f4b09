#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "apps/campaign/report.h"
#include "hal/shown_text.h"

namespace jaywalk::campaign {
namespace {

using Figure = std::function<double(const ReportedRun&)>;

constexpr std::size_t kFewestPairs = 5;  // of a comparison

std::size_t count_if(const std::vector<ReportedRun>& runs, const std::function<bool(const RunResult&)>& holds) {
  return static_cast<std::size_t>(std::ranges::count_if(runs, holds, &ReportedRun::result));
}

std::size_t count_above_0(const std::vector<ReportedRun>& runs, const char* figure) {
  return count_if(runs, [&](const RunResult& result) { return result.figure(figure) > 0.0; });
}

bool succeeded(const RunResult& result) { return result.success; }

std::string success_cell(const std::vector<ReportedRun>& runs) {
  return std::to_string(count_if(runs, succeeded)) + " of " + std::to_string(runs.size());
}

std::vector<double> values_of(const std::vector<ReportedRun>& runs, const Figure& figure) {
  std::vector<double> values;
  for (const ReportedRun& run : runs) values.push_back(figure(run));
  return values;
}

/// NaN of runs that did not arrive: how they drove says nothing about a way that they did not finish.
Figure of_arrived(const Figure& figure) {
  return [figure](const ReportedRun& run) { return run.result.arrived() ? figure(run) : kUnknown; };
}

Figure plain(const char* name) {
  return [name](const ReportedRun& run) { return run.result.figure(name); };
}

double length_over_shortest(const ReportedRun& run) {
  return run.result.figure("path_length_m") / run.result.figure("static_shortest_path_m");
}

/// Against the shortest path at the greatest speed.
double time_over_shortest_s(const ReportedRun& run) {
  return run.result.figure("duration_s") - run.result.figure("static_shortest_path_m") / run.run->cruise_mps;
}

Figure a_minute(const char* name) {
  return [name](const ReportedRun& run) { return run.result.figure(name) / (run.result.figure("duration_s") / 60.0); };
}

std::string share_cell(const std::vector<ReportedRun>& runs) {
  if (runs.empty()) return "-";
  const std::size_t good = count_if(runs, succeeded);
  const Interval interval = wilson(good, runs.size());
  return fixed(100.0 * static_cast<double>(good) / static_cast<double>(runs.size()), 1) + " % (" +
         fixed(100.0 * interval.low, 0) + "-" + fixed(100.0 * interval.high, 0) + ")";
}

double sum_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += std::isnan(value) ? 0.0 : value;
  return sum;
}

/// Heads and cells of a row of the table.
std::vector<std::pair<std::string, std::string>> success_columns(const std::vector<ReportedRun>& runs) {
  const auto number = [&](const auto& holds) { return std::to_string(count_if(runs, holds)); };
  const auto ended = [&](const char* as) { return number([as](const RunResult& r) { return r.outcome == as; }); };
  const auto above_0 = [&](const char* figure) { return std::to_string(count_above_0(runs, figure)); };
  const auto sum = [&](const char* figure) { return fixed(sum_of(values_of(runs, plain(figure))), 0); };
  return {{"success", success_cell(runs)},
          {"share (95 %)", share_cell(runs)},
          {"forced a mover", ended("forced_mover")},
          {"collision", ended("collision")},
          {"timeout", ended("timeout")},
          {"fault", ended("fault")},
          {"did not run", number([](const RunResult& r) { return !r.ran(); })},
          {"contact-free", number([](const RunResult& r) { return r.ran() && r.figure("contacts") == 0.0; })},
          {"touched while driving", above_0("contacts_caused")},
          {"movers made to turn", sum("forced_movers")},
          {"stops by faults", sum("faults")},
          {"runs with a loop", above_0("loops")}};
}

ReportTable success_table(const ReportedTables& tables) {
  ReportTable table{"Success", {""}, {}};
  for (const auto& [head, cell] : success_columns({})) table.head.push_back(head);
  for (const ReportedRow& row : tables.rows) {
    table.rows.push_back({row.name});
    for (const auto& [head, cell] : success_columns(row.runs)) table.rows.back().push_back(cell);
  }
  return table;
}

struct RideFigure {
  const char* name;
  Figure of;
  int digits;
  bool less_is_worse = false;  ///< 5th percentile and least stand in place of 95th and largest
};

std::vector<RideFigure> ride_figures() {
  return {{"length over shortest", length_over_shortest, 2},
          {"time lost, s", time_over_shortest_s, 1},
          {"steering reversals a minute", a_minute("steering_reversals"), 1},
          {"speed reversals a minute", a_minute("speed_reversals"), 1},
          {"stood, %", [](const ReportedRun& run) { return 100.0 * run.result.figure("stood_share"); }, 1},
          {"detours, m", plain("detour_m"), 1},
          {"largest acceleration, m/s2", plain("accel_max_mps2"), 2},
          {"hard brakes a minute", a_minute("hard_brakes"), 1},
          {"jerk p99, m/s3", plain("jerk_p99_mps3"), 2},
          {"the same but for hard brakes", plain("calm_jerk_p99_mps3"), 2},
          {"largest jerk, m/s3", plain("jerk_max_mps3"), 2},
          {"nearest to a mover, m (5th, least)", plain("min_mover_clearance_m"), 2, true}};
}

/// HuNavSim's measures (hal/types/social_measures.h).
std::vector<RideFigure> people_figures() {
  return {{"in intimate space, s", plain("intimate_s"), 1},
          {"in personal space, s", plain("personal_s"), 1},
          {"way that people lost, m", plain("slowed_m"), 1},
          {"turning of people, rad", plain("turned_rad"), 1}};
}

bool has_social_movers(const ReportedTables& tables) {
  return std::ranges::any_of(tables.rows, [](const auto& row) { return count_above_0(row.runs, "slowed_m") > 0; });
}

/// Median, 95th percentile and largest of runs that arrived.
ReportTable figure_table(const ReportedTables& tables, const char* title, const std::vector<RideFigure>& figures) {
  const auto cell = [](const ReportedRow& row, const RideFigure& figure) {
    const std::vector<double> values = values_of(row.runs, of_arrived(figure.of));
    const double rare = figure.less_is_worse ? 0.05 : 0.95, worst = figure.less_is_worse ? 0.0 : 1.0;
    return fixed(median(values), figure.digits) + " / " + fixed(quantile(values, rare), figure.digits) + " / " +
           fixed(quantile(values, worst), figure.digits);
  };
  return table_with(title, tables.rows, figures, std::mem_fn(&RideFigure::name), cell);
}

/// A row for each setting of which a person steered runs.
ReportTable stick_table(const ReportedTables& tables) {
  ReportTable table{"Driving by the stick",
                    {"", "runs", "touched something", "at over 0.05 m/s", "least clearance, m",
                     "of the wish granted, %, mean", "least of a run"},
                    {}};
  for (const ReportedRow& row : tables.rows) {
    const std::vector<double> granted = values_of(row.runs, plain("granted_share"));
    if (std::isnan(mean(granted))) continue;
    table.rows.push_back({row.name, std::to_string(row.runs.size()),
                          std::to_string(count_above_0(row.runs, "contacts")),
                          std::to_string(count_above_0(row.runs, "contacts_caused")),
                          fixed(quantile(values_of(row.runs, plain("min_clearance_m")), 0.0), 3),
                          fixed(100.0 * mean(granted), 1), fixed(100.0 * quantile(granted, 0.0), 1)});
  }
  return table;
}

/// A cell for each scenario, of the runs that the row has there.
ReportTable by_scenario(const ReportedTables& tables, const std::string& title,
                        const std::function<std::string(const std::vector<ReportedRun>&)>& cell) {
  const auto there = [&](const ReportedRow& row, const std::string& scenario) {
    std::vector<ReportedRun> runs = row.runs;
    std::erase_if(runs, [&](const ReportedRun& run) { return run.run->scenario != scenario; });
    return cell(runs);
  };
  return table_with(title, tables.rows, tables.experiment->scenarios, std::identity(), there);
}

std::string length_cell(const std::vector<ReportedRun>& runs) {
  return fixed(mean(values_of(runs, of_arrived(plain("path_length_m")))), 1);
}

/// Bins of 10 degrees, the rare wide ones together.
ReportTable turn_table(const ReportedTables& tables) {
  using Bins = std::pair<std::ptrdiff_t, std::ptrdiff_t>;  // first, end
  constexpr std::array<Bins, 6> kBins{{{0, 1}, {1, 2}, {2, 3}, {3, 6}, {6, 9}, {9, kTurnBins}}};
  const auto head = [](const Bins& bins) {
    return std::to_string(10 * bins.first) + "-" + std::to_string(10 * bins.second) + " deg";
  };
  const auto cell = [](const ReportedRow& row, const Bins& bins) {
    const std::vector<double> turns = turns_of(row);
    const double some = sum_of({turns.begin() + bins.first, turns.begin() + bins.second});
    return fixed(100.0 * some / sum_of(turns), 2);
  };
  return table_with("Turning angles every 0.25 m, % of all", tables.rows, kBins, head, cell);
}

/// Whether one axis alone tells two rows apart; not where it is another world: movers and maps are not paired.
bool are_comparable(const ReportedExperiment& experiment, const ReportedRow& a, const ReportedRow& b) {
  std::size_t different = 0;
  for (std::size_t k = 0; k < a.values.size(); ++k) {
    if (a.values[k] == b.values[k]) continue;
    if (experiment.axes[k].starts_with("movers.") || experiment.axes[k].starts_with("map.")) return false;
    ++different;
  }
  return different == 1;
}

/// "4.1 (2.0 to 6.2), 20 pairs": of `to` less `from`, runs with the same scenario and seed.
std::string difference(const ReportedRow& from, const ReportedRow& to, const Figure& figure, int digits) {
  std::vector<double> differences;
  for (const ReportedRun& a : from.runs) {
    const auto same = std::ranges::find_if(to.runs, [&](const ReportedRun& b) {
      return b.run->scenario == a.run->scenario && b.run->seed == a.run->seed;
    });
    if (same == to.runs.end()) continue;
    if (const double change = figure(*same) - figure(a); std::isfinite(change)) differences.push_back(change);
  }
  if (differences.size() < kFewestPairs) return "-";
  const double middle = mean(differences), half = half_interval(differences);
  return without_minus_zero(fixed(middle, digits) + " (" + fixed(middle - half, digits) + " to " +
                            fixed(middle + half, digits) + "), ") +
         std::to_string(differences.size());
}

}  // namespace

std::vector<double> turns_of(const ReportedRow& row) {
  std::vector<double> turns(kTurnBins);
  for (const ReportedRun& run : row.runs)
    for (std::size_t k = 0; k < kTurnBins; ++k) turns[k] += run.result.turns[k];
  return turns;
}

std::vector<ReportTable> tables_of(const ReportedTables& tables) {
  const bool few = tables.experiment->scenarios.size() <= kMostColumns;
  std::vector<ReportTable> all{success_table(tables)};
  if (few) all.push_back(by_scenario(tables, "Success by scenario", success_cell));
  all.push_back(
      figure_table(tables, "The ride, of runs that arrived: median / 95th percentile / largest", ride_figures()));
  if (has_social_movers(tables))
    all.push_back(
        figure_table(tables, "People, in runs that arrived: median / 95th percentile / largest", people_figures()));
  if (few) all.push_back(by_scenario(tables, "Path length by scenario, m, mean of runs that arrived", length_cell));
  all.push_back(turn_table(tables));
  all.push_back(stick_table(tables));
  all.push_back(paired_table(tables));
  std::erase_if(all, [](const ReportTable& table) { return table.rows.empty(); });
  return all;
}

double time_lost_s(const ReportedRun& run) { return of_arrived(time_over_shortest_s)(run); }

ReportTable paired_table(const ReportedTables& tables) {
  ReportTable table{"Pairs of the same seeds: mean difference (95 % interval), pairs", {"", "success, % of runs"}, {}};
  for (const RideFigure& figure : ride_figures()) table.head.emplace_back(figure.name);
  const Figure success = [](const ReportedRun& run) { return run.result.success ? 100.0 : 0.0; };
  for (auto to = tables.rows.begin(); to != tables.rows.end(); ++to) {
    const auto from = std::find_if(
        tables.rows.begin(), to, [&](const ReportedRow& row) { return are_comparable(*tables.experiment, row, *to); });
    const std::string whole = difference(*from, *to, success, 1);
    if (from == to || whole == "-") continue;
    std::vector<std::string> cells{to->name + ", less " + from->name, whole};
    for (const RideFigure& figure : ride_figures())
      cells.push_back(difference(*from, *to, of_arrived(figure.of), figure.digits));
    table.rows.push_back(cells);
  }
  return table;
}

ReportTable runs_table(const std::vector<ReportedTables>& all) {
  std::vector<RideFigure> figures = ride_figures();
  figures.insert(figures.begin(), {{"time, s", plain("duration_s"), 1}, {"way, m", plain("path_length_m"), 1}});
  figures.insert(figures.end(), {{"touched while driving", plain("contacts_caused"), 0},
                                 {"movers made to turn", plain("forced_movers"), 0},
                                 {"loops", plain("loops"), 0}});
  ReportTable table{"All runs", {"run", "outcome"}, {}};
  for (const RideFigure& figure : figures) table.head.emplace_back(figure.name);
  for_each_run(all, [&](const ReportedRun& run) {
    std::vector<std::string> cells{run.run->folder, run.result.outcome};
    for (const RideFigure& figure : figures) cells.push_back(fixed(figure.of(run), figure.digits));
    table.rows.push_back(cells);
  });
  return table;
}

std::vector<std::pair<std::string, std::string>> cards_of(const std::vector<ReportedTables>& all) {
  std::size_t runs = 0, good = 0, touched = 0, looped = 0;
  std::vector<double> lost_s, nearest_m;
  for_each_run(all, [&](const ReportedRun& run) {
    ++runs, good += run.result.success ? 1U : 0U;
    touched += run.result.figure("contacts_caused") > 0.0 ? 1U : 0U;
    looped += run.result.figure("loops") > 0.0 ? 1U : 0U;
    lost_s.push_back(time_lost_s(run));
    nearest_m.push_back(run.result.figure("min_mover_clearance_m"));
  });
  const Interval interval = wilson(good, runs);
  return {{std::to_string(good) + " of " + std::to_string(runs),
           "succeeded: " + fixed(100.0 * interval.low, 0) + " to " + fixed(100.0 * interval.high, 0) + " % (95 %)"},
          {std::to_string(touched), "runs touched something while driving"},
          {std::to_string(looped), "runs with a loop"},
          {fixed(median(lost_s), 1) + " s", "lost against the shortest way, median of arrived runs"},
          {fixed(quantile(nearest_m, 0.05), 2) + " m", "to the nearest mover, 5th percentile"}};
}

}  // namespace jaywalk::campaign
