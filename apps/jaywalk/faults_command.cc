#include <algorithm>
#include <array>
#include <cstdio>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "apps/jaywalk/commands.h"
#include "hal/shown_text.h"
#include "hal/text_file.h"
#include "hil/faults/fault_matrix.h"

namespace jaywalk {
namespace {

using faults::FaultResult;

double in_ms(Duration d) { return 1e3 * to_seconds(d); }

std::string csv_row(const FaultResult& row) {
  return formatted("%s,%s,%.1f,%.0f,%.0f,%.3f,%d,%d\n", row.fault->name, faults::name_of(row.drive), row.speed_mps,
                   in_ms(row.reaction), in_ms(row.limit), row.stop_distance_m, row.latched ? 1 : 0,
                   row.why_not.empty() ? 1 : 0);
}

void print(const FaultResult& row) {
  std::printf("%-4s  %-24s %-7s %.1f m/s  %5.0f of %4.0f ms  %6.3f m  %-7s  %s\n", row.why_not.empty() ? "ok" : "FAIL",
              row.fault->name, faults::name_of(row.drive), row.speed_mps, in_ms(row.reaction), in_ms(row.limit),
              row.stop_distance_m, row.latched ? "latched" : "-", row.why_not.c_str());
}

constexpr std::size_t kKinds = 5;  // of drives
using Rows = std::span<const FaultResult>;

/// The slowest, and its limit.
struct Reaction {
  Duration slowest{0}, limit{0};

  void add(const Reaction& other) { slowest = std::max(slowest, other.slowest), limit = std::max(limit, other.limit); }
  [[nodiscard]] std::string words() const { return formatted("%.0f/%.0f", in_ms(slowest), in_ms(limit)); }
};

/// Cells of a fault's row: the slowest reaction of all drives, the Pioneer's apart where its limit differs, then each
/// drive's stopping distances, m, by speed.
std::string figures_of(Rows rows) {
  std::array<std::string, kKinds> ways;
  Reaction all, pioneer, others;
  for (const FaultResult& row : rows) {
    all.add({row.reaction, row.limit});
    (row.drive == DriveKind::kPioneer ? pioneer : others).add({row.reaction, row.limit});
    std::string& way = ways.at(static_cast<std::size_t>(row.drive));
    way += formatted("%s%.2f", way.empty() ? "" : "/", row.stop_distance_m);
  }
  const bool one = others.limit == pioneer.limit || std::min(others.limit, pioneer.limit) == Duration{0};
  std::string figures = "|" + (one ? all.words() : others.words() + ", " + pioneer.words());
  for (const DriveKind kind : {DriveKind::kCia402, DriveKind::kOdrive, DriveKind::kVesc, DriveKind::kPioneer}) {
    const std::string& way = ways.at(static_cast<std::size_t>(kind));
    figures += "|" + (way.empty() ? "-" : way);
  }
  const bool ok = std::ranges::all_of(rows, [](const FaultResult& row) { return row.why_not.empty(); });
  return (rows.front().latched ? "" : " (not latched)") + figures + (ok ? "\n" : " **not ok**\n");
}

constexpr const char* kMatrixHead = R"(# Fault matrix

Generated: `faults.md` of `jaywalk faults`. A simulated robot with emulated drives and an emulated SICK drives down a hall;
front and rear faults are of one with a second SICK. *Reaction*: the slowest of all runs, and its limit. *To rest*: metres
from the fault, at 0.3/0.6/1.2 m/s. An ODrive that lets go coasts; a Pioneer, whose reactions come second where its limit
differs, reports every 100 ms. All wait for a reset but those marked. Single runs: [faults.csv](outputs.md#fault-matrix).

fault|reaction/limit, ms|to rest: cia402|odrive|vesc|pioneer
---|---|---|---|---|---
)";

constexpr std::size_t kLongestRow = 155;

/// docs/reference/fault-matrix.md: faults with the same figures share a line.
std::string markdown(const std::vector<FaultResult>& rows) {
  std::vector<std::pair<std::string, std::string>> lines;  // faults, figures
  for (std::size_t first = 0, end = 0; first < rows.size(); first = end) {
    while (end < rows.size() && rows[end].fault == rows[first].fault) ++end;
    const std::string figures = figures_of(Rows(rows).subspan(first, end - first));
    const std::string name = rows[first].fault->name;
    const auto same = std::find_if(lines.begin(), lines.end(), [&](const auto& line) {
      return line.second == figures && line.first.size() + name.size() + figures.size() < kLongestRow;
    });
    if (same == lines.end())
      lines.emplace_back(name, figures);
    else
      same->first += ", " + name;
  }
  std::string text = kMatrixHead;
  for (const auto& [names, figures] : lines) text += names + figures;
  return text;
}

/// `rate_hz`: of the control loop.
int run_faults(const std::filesystem::path& out, double rate_hz) {
  const std::filesystem::path scratch = out / "last_run";
  std::error_code failed;
  std::filesystem::create_directories(scratch, failed);
  std::string csv = "fault,drive,speed_mps,reaction_ms,limit_ms,stop_distance_m,latched,ok\n";
  std::vector<FaultResult> rows;
  const std::filesystem::path table = out / "faults.csv";
  write_text(table, csv, faults::kOtherOut);
  const int bad = faults::run_matrix(rate_hz, scratch, [&](const FaultResult& row) {
    csv += csv_row(row);
    print(row);
    rows.push_back(row);
  });
  write_text(table, csv, faults::kOtherOut);
  write_text(out / "faults.md", markdown(rows), faults::kOtherOut);
  const int count = static_cast<int>(rows.size());
  std::printf("%d of %d rows ok; %s\n", count - bad, count, table.string().c_str());
  return bad == 0 ? 0 : 1;
}

}  // namespace

void add_faults(CLI::App& app, int& exit_code) {
  static std::filesystem::path out = "out/faults";
  static double rate_hz = 50.0;
  CLI::App* faults =
      app.add_subcommand("faults", "The fault matrix: every fault, drive and speed on the simulated robot");
  faults->add_option("--out", out, "Folder for faults.csv")->capture_default_str();
  faults->add_option("--rate-hz", rate_hz, "Rate of the control loop")
      ->check(CLI::Range(25.0, 200.0))
      ->capture_default_str();
  faults->callback([&exit_code] { exit_code = run_faults(out, rate_hz); });
}

}  // namespace jaywalk
