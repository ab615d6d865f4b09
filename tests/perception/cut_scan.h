#pragma once
// A scan from the origin, cut at its jumps.
#include "planner/mapping/map_entry.h"
#include "planner/scan/scan_points.h"
#include "planner/tracking/detection.h"

namespace jaywalk::test {

/// Points, segments and, once found, detections of a scan over ground that was free. Large: for the heap.
struct CutScan : ScanPieces {
  explicit CutScan(const LaserScan& scan) {
    sweep = sweep_of(scan);
    ScanProjection().project(scan, {}, {}, points);
    begin_at_a_jump(sweep, points);
    for (std::size_t k = 0; k < points.size(); ++k) in_map.position[k] = points[k].in_robot;
    in_map.ground.fill(Ground::kFree);
    cut_at_jumps(points, sweep, segments);
  }
  void find() { find_detections(*this, {}, detections); }
  /// The last detection within `within_m` of a place, or none.
  [[nodiscard]] const Detection* near(Vec2 place, double within_m) const {
    const Detection* found = nullptr;
    for (const Detection& c : detections) found = distance(c.centre_in_map, place) < within_m ? &c : found;
    return found;
  }

  Detections detections;
};

}  // namespace jaywalk::test
