#include "firmware/commands/faults_command.h"

#include <cstdio>
#include <fstream>

#include "firmware/faults/fault_matrix.h"
#include "firmware/faults/matrix_files.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

using faults::FaultResult;

double in_ms(Duration d) { return 1e3 * to_seconds(d); }

std::string csv_row(const FaultResult& row) {
  char text[200];
  std::snprintf(text, sizeof text, "%s,%s,%.1f,%.0f,%.0f,%.3f,%d,%d\n", row.fault->name, faults::name_of(row.drive),
                row.speed_mps, in_ms(row.reaction), in_ms(row.fault->limit), row.stop_distance_m, row.latched ? 1 : 0,
                row.why_not.empty() ? 1 : 0);
  return text;
}

void print(const FaultResult& row) {
  std::printf("%-4s  %-24s %-7s %.1f m/s  %5.0f of %4.0f ms  %6.3f m  %-7s  %s\n", row.why_not.empty() ? "ok" : "FAIL",
              row.fault->name, faults::name_of(row.drive), row.speed_mps, in_ms(row.reaction), in_ms(row.fault->limit),
              row.stop_distance_m, row.latched ? "latched" : "-", row.why_not.c_str());
}

}  // namespace

int run_faults(const FaultsOptions& options) {
  const std::filesystem::path scratch = options.out / "last_run";
  std::error_code failed;
  std::filesystem::create_directories(scratch, failed);
  const std::filesystem::path table = options.out / "faults.csv";
  std::ofstream csv(table);
  csv << "fault,drive,speed_mps,reaction_ms,limit_ms,stop_distance_m,latched,ok\n";
  int rows = 0;
  const int bad = faults::run_matrix(scratch, [&](const FaultResult& row) {
    csv << csv_row(row);
    print(row);
    ++rows;
  });
  csv.flush();
  if (!csv) throw StartupError(table.string() + ": cannot be written", "choose another --out, or free some space");
  std::printf("%d of %d rows ok; %s\n", rows - bad, rows, table.string().c_str());
  return bad == 0 ? 0 : 1;
}

}  // namespace jaywalk
