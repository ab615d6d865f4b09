#include "bench/tracking/reference_poses.h"

#include "hal/sim/logs/line_file.h"
#include "hal/types/errors.h"
#include "hal/types/laser_scan.h"

namespace jaywalk::bench {

ReferencePoses reference_poses(const std::filesystem::path& log, const RunFolder& run) {
  ReferencePoses out;
  sim::LineFile file(log);
  while (file.next()) {
    if (file.words().front() != "FLASER") continue;
    const std::size_t first = 2 + file.count(1, kMaxBeams);  // x y heading, the wheels' the same, t host t
    if (file.words().size() < first + 9) file.refuse("the line is too short", "end FLASER lines with poses and times");
    const auto pose = [&](std::size_t k) { return Pose2{file.number(k), file.number(k + 1), file.number(k + 2)}; };
    const Pose2 corrected = pose(first);
    out.of_run.push_back({run.estimate_at(file.seconds(first + 8)), corrected});
    out.of_wheels.push_back({pose(first + 3), corrected});
  }
  if (out.of_run.empty())
    throw StartupError(log.string() + ": no FLASER lines", "give the CARMEN log that was replayed");
  return out;
}

}  // namespace jaywalk::bench
