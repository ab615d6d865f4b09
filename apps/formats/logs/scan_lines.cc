#include "apps/formats/logs/scan_lines.h"

namespace jaywalk::sim {

bool add_scan(LogScans& scans, const LineFile& file, const RecordedScan& scan, std::size_t first_word,
              double nothing_from_m) {
  std::vector<double> ranges(scan.beams);
  for (std::size_t i = 0; i < scan.beams; ++i) ranges[i] = file.number(first_word + i);
  return scans.add(file.place(), scan, ranges, nothing_from_m);
}

Pose2 pose_at(const LineFile& file, std::size_t i) { return {file.number(i), file.number(i + 1), file.number(i + 2)}; }

}  // namespace jaywalk::sim
