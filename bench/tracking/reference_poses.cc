#include "bench/tracking/reference_poses.h"

#include "apps/formats/logs/log_checks.h"
#include "bench/tracking/number_table.h"
#include "hal/types/errors.h"
#include "hal/types/laser_scan.h"

namespace jaywalk::bench {
namespace {

bool is_table(const std::filesystem::path& file) {
  return (file.extension() == ".gz" ? file.stem() : file).extension() == ".csv";
}

ReferencePoses of_table(const std::filesystem::path& file, const RunFolder& run) {
  const NumberTable table(file);
  const auto t = table.column("t"), x = table.column("x"), y = table.column("y"), h = table.column("h");
  run.require_own_times(file.string(), t);
  ReferencePoses out;
  for (std::size_t k = 0; k < table.rows(); ++k) out.of_run.push_back({run.estimate_at(t[k]), {x[k], y[k], h[k]}});
  return out;
}

}  // namespace

ReferencePoses reference_poses(const std::filesystem::path& log, const RunFolder& run) {
  if (is_table(log)) return of_table(log, run);
  ReferencePoses out;
  std::vector<double> times;
  sim::LineFile file(log);
  while (file.next()) {
    if (file.words().front() != "FLASER") continue;
    // After the ranges: x y heading, the wheels' the same, t host t. The replay goes by the first of the times.
    const std::size_t first = file.words().size() > 1 ? 2 + file.count(1, kMaxBeams) : 2;
    if (file.words().size() < first + 9) file.refuse("the line is too short", "end FLASER lines with poses and times");
    const Pose2 corrected = sim::pose_at(file, first);
    times.push_back(file.seconds(first + 6));
    out.of_run.push_back({run.estimate_at(times.back()), corrected});
    out.of_wheels.push_back({sim::pose_at(file, first + 3), corrected});
  }
  if (out.of_run.empty())
    throw StartupError(log.string() + ": no FLASER lines", "give the CARMEN log that was replayed");
  run.require_own_times(log.string(), times);
  return out;
}

}  // namespace jaywalk::bench
