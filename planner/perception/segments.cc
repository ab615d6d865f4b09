#include "planner/perception/segments.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

constexpr double kJumpM = 0.12;      // surfaces closer than this are one thing: a leg is 0.1 m across
constexpr double kJumpSteps = 3.0;   // or than this many beam spacings: a surface seen at 70 degrees
constexpr double kWidestM = 1.1;     // wider things are walls
constexpr double kFarthestM = 12.0;  // beyond, a person is too few points and a heading error too many cells
constexpr double kMostWall = 0.4;    // of a body's points may lie on a wall
constexpr double kMostFree = 0.6;    // of its points in free space: it came there
constexpr std::uint32_t kFewestPoints = 3;
constexpr double kLegsM = 0.35;           // wider than a leg, or two side by side
constexpr double kWallNoiseM = 0.10;      // a wall's points scatter this far about where the map holds it
constexpr double kWallNoisePerM = 0.012;  // and this much more a metre of range: 0.7 degrees of heading

double jump_distance(double range, double angle_step) {
  return std::max(kJumpM, kJumpSteps * range * std::fabs(angle_step));
}

Outline outline_of(const Segment& segment, const PointsInMap& in_map) {
  Outline outline;
  const std::uint32_t span = segment.last - segment.first, most = static_cast<std::uint32_t>(Outline::capacity() - 1);
  for (std::uint32_t k = 0; k <= most; ++k) (void)outline.push_back(in_map.position[segment.first + span * k / most]);
  return outline;
}

/// Mean of the segment's points, moved back along the beam by what the visible arc stands before its centre.
Cluster cluster_of(const Segment& segment, const ScanPoints& points, const PointsInMap& in_map, Vec2 laser) {
  Vec2 sum;
  for (std::uint32_t k = segment.first; k <= segment.last; ++k) sum = sum + in_map.position[k];
  const Vec2 mean = sum * (1.0 / (segment.last - segment.first + 1));
  const double range = std::max(distance(laser, mean), 1e-6);
  const Vec2 along = (mean - laser) * (1.0 / range);
  const double across = cross(along, in_map.position[segment.last] - in_map.position[segment.first]);
  const double width = std::fabs(across);
  const double spacing = width / std::max(1U, segment.last - segment.first);  // the arc's ends lie between beams
  const double radius = 0.5 * (width + spacing);
  return {.segment = segment,
          .centre_in_map = mean + along * (kArcMean * radius),
          .radius_m = radius,
          .range_m = points[segment.first].range_m,
          .spacing_m = spacing,
          .outline_in_map = outline_of(segment, in_map),
          .along = along,
          .high_side = Vec2{-along.y, along.x} * (across < 0.0 ? -1.0 : 1.0)};
}

struct GroundShares {
  double wall = 0.0, free = 0.0;
};

GroundShares shares_of(const Segment& segment, const PointsInMap& in_map) {
  double wall = 0.0, free = 0.0;
  for (std::uint32_t k = segment.first; k <= segment.last; ++k) {
    wall += in_map.ground[k] == Ground::kWall ? 1.0 : 0.0;
    free += in_map.ground[k] == Ground::kFree ? 1.0 : 0.0;
  }
  const double count = segment.last - segment.first + 1;
  return {wall / count, free / count};
}

/// `beside` is the point before `end` or after it; past either end of the list there is none.
End end_at(const ScanPoints& points, std::size_t end, std::size_t beside) {
  if (beside >= points.size()) return End::kUnknown;
  const std::uint32_t low = std::min(points[end].beam, points[beside].beam);
  if (std::max(points[end].beam, points[beside].beam) - low != 1) return End::kUnknown;
  return points[beside].range_m <= points[end].range_m ? End::kHidden : End::kSeen;
}

void note_ends(const ScanPoints& points, std::uint32_t last_beam, Cluster& cluster) {
  const std::size_t first = cluster.segment.first, last = cluster.segment.last;
  cluster.beams = {points[first].beam, points[last].beam};
  cluster.low_end = cluster.beams.first == 0 ? End::kHidden : end_at(points, first, first - 1);
  cluster.high_end = cluster.beams.last == last_beam ? End::kHidden : end_at(points, last, last + 1);
}

/// Whether the neighbouring segment that hides the cluster, itself segment `n`, may hide more than a leg.
void note_what_hides(const Segments& segments, std::size_t n, const PointsInMap& in_map, Cluster& cluster) {
  const auto wide = [&](std::size_t s) {
    return s < segments.size() &&
           distance(in_map.position[segments[s].first], in_map.position[segments[s].last]) > kLegsM;
  };
  cluster.behind_more = (cluster.low_hidden() && wide(n - 1)) || (cluster.high_hidden() && wide(n + 1));
}

bool body_sized(const Segment& segment, const ScanPoints& points, const PointsInMap& in_map) {
  return segment.last - segment.first + 1 >= kFewestPoints && points[segment.first].range_m < kFarthestM &&
         distance(in_map.position[segment.first], in_map.position[segment.last]) < kWidestM;
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

Ground ground_at(const EvidenceMap& still, Vec2 p, double range) noexcept {
  const CellIndex cell = still.cell_at(p);
  const double near = kWallNoiseM + kWallNoisePerM * range;
  const std::int32_t reach = near > still.cell_m() ? 2 : 1;
  for (std::int32_t j = -reach; j <= reach; ++j) {
    for (std::int32_t i = -reach; i <= reach; ++i) {
      const CellIndex c{cell.i + i, cell.j + j};
      if (still.stands(c) && distance(still.surface(c), p) < near) return Ground::kWall;
    }
  }
  return still.seen_free(cell) ? Ground::kFree : Ground::kUnknown;
}

void find_clusters(const ScanPoints& points, const PointsInMap& in_map, const Segments& segments,
                   std::uint32_t last_beam, Vec2 laser, Clusters& out) noexcept {
  out.clear();
  for (std::size_t n = 0; n < segments.size(); ++n) {
    const Segment& segment = segments[n];
    if (!body_sized(segment, points, in_map)) continue;
    const GroundShares shares = shares_of(segment, in_map);
    if (shares.wall > kMostWall) continue;
    Cluster cluster = cluster_of(segment, points, in_map, laser);
    cluster.in_free_space = shares.free > kMostFree;
    note_ends(points, last_beam, cluster);
    note_what_hides(segments, n, in_map, cluster);
    if (!cluster.in_free_space && cluster.low_hidden() && cluster.high_hidden()) continue;
    if (!out.push_back(cluster)) return;
  }
}

}  // namespace jaywalk
