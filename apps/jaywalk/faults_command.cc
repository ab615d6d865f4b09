#include "apps/jaywalk/faults_command.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "hil/faults/fault_matrix.h"
#include "hil/faults/matrix_files.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

using faults::FaultResult;

double in_ms(Duration d) { return 1e3 * to_seconds(d); }

std::string csv_row(const FaultResult& row) {
  char text[200];
  std::snprintf(text, sizeof text, "%s,%s,%.1f,%.0f,%.0f,%.3f,%d,%d\n", row.fault->name, faults::name_of(row.drive),
                row.speed_mps, in_ms(row.reaction), in_ms(row.limit), row.stop_distance_m, row.latched ? 1 : 0,
                row.why_not.empty() ? 1 : 0);
  return text;
}

void print(const FaultResult& row) {
  std::printf("%-4s  %-24s %-7s %.1f m/s  %5.0f of %4.0f ms  %6.3f m  %-7s  %s\n", row.why_not.empty() ? "ok" : "FAIL",
              row.fault->name, faults::name_of(row.drive), row.speed_mps, in_ms(row.reaction), in_ms(row.limit),
              row.stop_distance_m, row.latched ? "latched" : "-", row.why_not.c_str());
}

/// A line for a fault and a kind of drive: its rows follow one another, a speed each.
std::string markdown_line(std::span<const FaultResult> rows) {
  Duration slowest{0}, longest{0};
  std::string distances;
  bool ok = true;
  for (const FaultResult& row : rows) {
    slowest = std::max(slowest, row.reaction);
    longest = std::max(longest, row.limit);
    ok = ok && row.why_not.empty();
    char text[40];
    std::snprintf(text, sizeof text, "%.2f | ", row.stop_distance_m);
    distances += text;
  }
  const FaultResult& first = rows.front();
  char text[300];
  std::snprintf(text, sizeof text, "| `%s` | %s | %.0f | %.0f | %s%s | %s |\n", first.fault->name,
                faults::name_of(first.drive), in_ms(slowest), in_ms(longest), distances.c_str(),
                first.latched ? "yes" : "no", ok ? "yes" : "**no**");
  return text;
}

/// The whole table as docs/safety.md has it.
std::string markdown(const std::vector<FaultResult>& rows) {
  std::string text =
      "| fault | drive | slowest reaction, ms | limit, ms | to rest, m, from 0.3 m/s | 0.6 m/s | 1.2 m/s | latched | "
      "ok |\n"
      "|---|---|---|---|---|---|---|---|---|\n";
  for (std::size_t first = 0, end = 0; first < rows.size(); first = end) {
    const auto same = [&](const FaultResult& row) {
      return row.fault == rows[first].fault && row.drive == rows[first].drive;
    };
    while (end < rows.size() && same(rows[end])) ++end;
    text += markdown_line(std::span(rows).subspan(first, end - first));
  }
  return text;
}

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text << std::flush;
  if (!file) throw StartupError(path.string() + ": cannot be written", "choose another --out, or free some space");
}

}  // namespace

int run_faults(const FaultsOptions& options) {
  const std::filesystem::path scratch = options.out / "last_run";
  std::error_code failed;
  std::filesystem::create_directories(scratch, failed);
  std::string csv = "fault,drive,speed_mps,reaction_ms,limit_ms,stop_distance_m,latched,ok\n";
  std::vector<FaultResult> rows;
  const std::filesystem::path table = options.out / "faults.csv";
  write(table, csv);
  const int bad = faults::run_matrix(options.rate_hz, scratch, [&](const FaultResult& row) {
    csv += csv_row(row);
    print(row);
    rows.push_back(row);
  });
  write(table, csv);
  write(options.out / "faults.md", markdown(rows));
  const int count = static_cast<int>(rows.size());
  std::printf("%d of %d rows ok; %s\n", count - bad, count, table.string().c_str());
  return bad == 0 ? 0 : 1;
}

}  // namespace jaywalk
