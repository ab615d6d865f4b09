#include "planner/perception/segments.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

constexpr double kJumpM = 0.12;      // surfaces closer than this are one thing: a leg is 0.1 m across
constexpr double kJumpSteps = 3.0;   // or than this many beam spacings: a surface seen at 70 degrees
constexpr double kWidestM = 1.1;     // wider things are walls
constexpr double kFarthestM = 12.0;  // beyond, a person is too few points and a heading error too many cells
constexpr double kShareFree = 0.6;   // of a segment's points
constexpr std::uint32_t kFewestPoints = 3;
constexpr double kWideSupportM = 6.0;  // beyond, one degree of heading is more than a cell: look two cells round

/// The mean of the half circle that parallel beams see lies pi/4 of the radius before its centre.
constexpr double kArcMean = kPi / 4.0;

double jump_distance(double range, double angle_step) {
  return std::max(kJumpM, kJumpSteps * range * std::fabs(angle_step));
}

/// Mean of the segment's points, moved back along the beam by what the visible arc stands before its centre.
Cluster cluster_of(const Segment& segment, const ScanPoints& points, const PointsInMap& in_map, Vec2 laser) {
  Vec2 sum;
  for (std::uint32_t k = segment.first; k <= segment.last; ++k) sum = sum + in_map.position[k];
  const Vec2 mean = sum * (1.0 / (segment.last - segment.first + 1));
  const double range = std::max(distance(laser, mean), 1e-6);
  const Vec2 along = (mean - laser) * (1.0 / range);
  const double width = std::fabs(cross(along, in_map.position[segment.last] - in_map.position[segment.first]));
  const double spacing = width / std::max(1U, segment.last - segment.first);  // the arc's ends lie between beams
  const double radius = 0.5 * (width + spacing);
  return {segment, mean + along * (kArcMean * radius), radius, points[segment.first].range_m, 0};
}

bool could_be_body(const Segment& segment, const ScanPoints& points, const PointsInMap& in_map) {
  const std::uint32_t count = segment.last - segment.first + 1;
  if (count < kFewestPoints || points[segment.first].range_m > kFarthestM) return false;
  if (distance(in_map.position[segment.first], in_map.position[segment.last]) > kWidestM) return false;
  std::uint32_t free = 0;
  for (std::uint32_t k = segment.first; k <= segment.last; ++k) free += in_map.in_free_space[k] ? 1U : 0U;
  return free >= kShareFree * count;
}

}  // namespace

void cut_at_jumps(const ScanPoints& points, double angle_step, Segments& out) noexcept {
  out.clear();
  for (std::uint32_t k = 0; k < points.size(); ++k) {
    const bool joined =
        k > 0 && distance(points[k - 1].in_robot, points[k].in_robot) <= jump_distance(points[k].range_m, angle_step);
    if (joined) {
      out.back().last = k;
    } else if (!out.push_back({k, k})) {
      return;
    }
  }
}

bool in_free_space(const EvidenceMap& still, Vec2 p, double range) noexcept {
  const CellIndex cell = still.cell_at(p);
  if (!still.seen_free(cell)) return false;
  const std::int32_t reach = range > kWideSupportM ? 2 : 1;
  for (std::int32_t j = -reach; j <= reach; ++j) {
    for (std::int32_t i = -reach; i <= reach; ++i) {
      if (still.occupied({cell.i + i, cell.j + j})) return false;
    }
  }
  return true;
}

void find_clusters(const ScanPoints& points, const PointsInMap& in_map, const Segments& segments, Vec2 laser,
                   Clusters& out) noexcept {
  out.clear();
  for (const Segment& segment : segments) {
    if (!could_be_body(segment, points, in_map)) continue;
    if (!out.push_back(cluster_of(segment, points, in_map, laser))) return;
  }
}

}  // namespace jaywalk
