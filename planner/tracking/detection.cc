#include "planner/tracking/detection.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "hal/types/trig.h"
#include "planner/scan/line_of_sight.h"

namespace jaywalk {
namespace {
constexpr double kPieceM = 1.1;          // wider things that may go on unseen are walls
constexpr double kFarthestSeenM = 12.0;  // beyond, a person is too few points and a heading error too many cells
constexpr double kMostWall = 0.4;        // of a body's points may lie on a wall
constexpr double kMostFree = 0.6;        // of its points in free space: it came there
constexpr std::uint32_t kFewestPoints = 3, kFewestOfLeg = 2;
constexpr double kBulge = 0.3;        // of half its width: 0.32 to 0.6 of discs from 0.7 m on, none of a flat thing
constexpr double kLegM = 0.1;         // across: where beams are farther apart than a third of it, legs have two points
constexpr double kLegsM = 0.35;       // wider than a leg, or two side by side
constexpr double kWellBeforeM = 1.0;  // farther than a person's other leg

Outline outline_of(const Segment& segment, const PointsInMap& in_map) {
  Outline outline;
  const std::uint32_t span = segment.last - segment.first, most = static_cast<std::uint32_t>(Outline::capacity() - 1);
  for (std::uint32_t k = 0; k <= most; ++k) (void)outline.push_back(in_map.position[segment.first + span * k / most]);
  return outline;
}

/// The angle from `middle`, a unit vector, to an end of the segment, rad: it lies half a step beyond its last beam, on
/// average.
double angle_to(Vec2 end_from_laser, Vec2 middle, const Sweep& sweep) {
  return std::fabs(atan2(cross(middle, end_from_laser), dot(middle, end_from_laser))) +
         0.5 * std::fabs(sweep.angle_step_rad);
}

/// The disc whose visible arc the segment's points are.
Detection detection_of(const Segment& segment, const ScanPieces& scan, Vec2 laser) {
  const auto& [points, in_map, segments, sweep] = scan;
  Vec2 sum;
  for (std::uint32_t k = segment.first; k <= segment.last; ++k) sum = sum + in_map.position[k];
  const Vec2 mean = sum * (1.0 / (segment.last - segment.first + 1));
  const double range = std::max(distance(laser, mean), 1e-6);
  const Vec2 along = (mean - laser) * (1.0 / range);
  const double across = cross(along, in_map.position[segment.last] - in_map.position[segment.first]);
  const double width = std::fabs(across);
  const double spacing = width / std::max(1U, segment.last - segment.first);  // the arc's ends lie between beams
  const double low = angle_to(in_map.position[segment.first] - laser, along, sweep);
  const double high = angle_to(in_map.position[segment.last] - laser, along, sweep);
  const SeenDisc disc = seen_disc(range, low + high);
  const Ends ends = ends_of(segment, points, sweep);
  const Vec2 chord_middle = (in_map.position[segment.first] + in_map.position[segment.last]) * 0.5;
  return {.segment = segment,
          .beams = {points[segment.first].beam, points[segment.last].beam},
          .centre_in_map = mean + along * (disc.range_m - range),
          .radius_m = std::max(disc.radius_m, 0.5 * (width + spacing)),
          .mean_in_map = mean,
          .mean_range_m = range,
          .low_rad = low,
          .high_rad = high,
          .range_m = points[segment.first].range_m,
          .spacing_m = spacing,
          .sparse = segment.last - segment.first + 1 < kFewestPoints,
          .outline_in_map = outline_of(segment, in_map),
          .along = along,
          .high_side = Vec2{-along.y, along.x} * (across < 0.0 ? -1.0 : 1.0),
          .low_end = ends.low,
          .high_end = ends.high,
          .bulges = dot(chord_middle - mean, along) > kBulge * disc.radius_m};
}

/// Share of the segment's points that lie on ground of this kind.
double share_on(Ground ground, const Segment& segment, const PointsInMap& in_map) {
  const double count = segment.last - segment.first + 1;
  const auto* const first = in_map.ground.data() + segment.first;
  return static_cast<double>(std::count(first, in_map.ground.data() + segment.last + 1, ground)) / count;
}

/// The item before `k` of a list, or after it by `step` 1, round the list's ends where the scan goes all round; the
/// list's size: there is none.
std::size_t beside(std::size_t k, std::ptrdiff_t step, std::size_t size, const Sweep& sweep) {
  const auto there = static_cast<std::ptrdiff_t>(k) + step, count = static_cast<std::ptrdiff_t>(size);
  if (there >= 0 && there < count) return static_cast<std::size_t>(there);
  return sweep.all_round ? static_cast<std::size_t>((there + count) % count) : size;
}

End end_at(const ScanPoints& points, const Sweep& sweep, std::size_t end, std::ptrdiff_t step) {
  if (step < 0 ? points[end].after_own : points[end].before_own) return End::kHidden;
  const std::size_t next = beside(end, step, points.size(), sweep);
  if (next == points.size() || !sweep.neighbours(points[end].beam, points[next].beam)) return End::kUnknown;
  return points[next].range_m <= points[end].range_m ? End::kHidden : End::kSeen;
}

void note_times(const ScanPoints& points, const Sweep& sweep, Detection& detection) {
  const auto& [first, last] = detection.segment;
  double sum = 0.0, sum2 = 0.0;
  for (std::uint32_t k = first; k <= last; ++k) {
    const double late_s = sweep.beam_s * points[k].beam;
    sum += late_s, sum2 += late_s * late_s;
  }
  const double count = last - first + 1;
  detection.late_s = sum / count;
  detection.late_std_s = std::sqrt(std::max(0.0, sum2 / count - detection.late_s * detection.late_s));
}

/// Range of segment `s`, by its first point, m.
double segment_range_m(const ScanPieces& scan, std::size_t s) { return scan.points[scan.segments[s].first].range_m; }

/// Whether what lies beside segment `s` on one side hides more of it than a leg does: the next segment is wide, or it
/// stands well before and goes on behind something nearer that is. Pieces of one heap hide each other, too.
bool hides_more(const ScanPieces& scan, std::size_t s, std::ptrdiff_t step) {
  const std::size_t none = scan.segments.size();
  std::size_t k = beside(s, step, none, scan.sweep);
  const bool well_before = k != none && segment_range_m(scan, k) < segment_range_m(scan, s) - kWellBeforeM;
  while (well_before && scan.width_m(scan.segments[k]) <= kLegsM) {
    const std::size_t beyond = beside(k, step, none, scan.sweep);
    if (beyond == none || segment_range_m(scan, beyond) >= segment_range_m(scan, k)) return false;
    k = beyond;
  }
  return k != none && scan.width_m(scan.segments[k]) > kLegsM;
}

std::uint32_t fewest_points(const ScanPieces& scan, std::size_t s) {
  const double spacing_m = segment_range_m(scan, s) * std::fabs(scan.sweep.angle_step_rad);
  return kFewestPoints * spacing_m > kLegM ? kFewestOfLeg : kFewestPoints;
}

/// By its ends and its middle: the ends of a wall all round the laser may meet.
bool body_sized(const ScanPieces& scan, std::size_t s) {
  const auto& [first, last] = scan.segments[s];
  const Vec2 middle = scan.in_map.position[first + (last - first) / 2];
  return last - first + 1 >= fewest_points(scan, s) && segment_range_m(scan, s) < kFarthestSeenM &&
         scan.width_m(scan.segments[s]) < kWidestBodyM && distance(scan.in_map.position[first], middle) < kWidestBodyM;
}

// Widest obstacle that may be a leg, m across: at 0.15 six of 103 labels of standing people are lost.
constexpr double kLegAcrossM = 0.2;
// Largest distance from beam to beam that shows the gap between two legs, m. No data on its choice.
constexpr double kBeamsApartM = 0.06;

double away_m(Vec2 place, const PointsInMap& in_map, const Segment& segment) {
  double least_m = distance(in_map.position[segment.first], place);
  for (std::uint32_t k = segment.first + 1; k <= segment.last; ++k)
    least_m = std::min(least_m, distance(in_map.position[k], place));
  return least_m;
}

/// Calls `each` with the cell and the eight about it, until it says no; whether it never did.
template <class Each>
bool all_about(CellIndex cell, const Each& each) {
  for (std::int32_t j = cell.j - 1; j <= cell.j + 1; ++j) {
    for (std::int32_t i = cell.i - 1; i <= cell.i + 1; ++i) {
      if (!each(CellIndex{i, j})) return false;
    }
  }
  return true;
}

}  // namespace

Ends ends_of(const Segment& segment, const ScanPoints& points, const Sweep& sweep) noexcept {
  const auto& [first, last] = segment;
  return {sweep.begins_at(points[first].beam) ? End::kHidden : end_at(points, sweep, first, -1),
          sweep.ends_at(points[last].beam) ? End::kHidden : end_at(points, sweep, last, 1)};
}

void find_detections(const ScanPieces& scan, Vec2 laser, Detections& out) noexcept {
  const auto& [points, in_map, segments, sweep] = scan;
  out.clear();
  for (std::size_t s = 0; s < segments.size(); ++s) {
    if (!body_sized(scan, s)) continue;
    Detection detection = detection_of(segments[s], scan, laser);
    detection.on_wall = share_on(Ground::kWall, segments[s], in_map) > kMostWall;
    detection.in_free_space = share_on(Ground::kFree, segments[s], in_map) > kMostFree;
    note_times(points, sweep, detection);
    if (scan.width_m(segments[s]) > kPieceM && !detection.ends()) continue;
    if (detection.on_wall && !detection.stands_alone()) continue;
    if (detection.sparse && !detection.whole()) continue;
    if (!detection.in_free_space && detection.low_hidden() && detection.high_hidden()) continue;
    detection.behind_more =
        (detection.low_hidden() && hides_more(scan, s, -1)) || (detection.high_hidden() && hides_more(scan, s, 1));
    if (!out.push_back(detection)) return;
  }
}

std::optional<bool> two_legs_at(Vec2 place, const ScanPieces& scan) noexcept {
  const auto& [points, in_map, segments, sweep] = scan;
  int thin = 0, whole = 0;
  for (const Segment& segment : segments) {
    if (points[segment.first].range_m * std::fabs(sweep.angle_step_rad) > kBeamsApartM) continue;
    const double there_m = away_m(place, in_map, segment);
    if (there_m > 0.5 * kStrideM) continue;
    const double width_m = scan.width_m(segment);
    if (width_m > kLegAcrossM) {
      if (there_m > kLegsReachM) continue;
      if (width_m > kBodyAcrossM) return false;
      return std::nullopt;
    }
    const Ends ends = ends_of(segment, points, sweep);
    const bool in_a_gap = ends.low == End::kHidden && ends.high == End::kHidden;  // a wall behind two legs
    thin += in_a_gap ? 0 : 1;
    whole += ends.seen() ? 1 : 0;
  }
  if (whole == 0 || (thin == 2 && whole == 1)) return std::nullopt;  // a leg is half hidden
  return thin == 2;
}

IsolatedObstacles::IsolatedObstacles(const EvidenceMap& map)
    : marks_(static_cast<std::size_t>(map.side()) * static_cast<std::size_t>(map.side()), kNew) {}

/// By their noise points lie a cell beside what they are of.
void IsolatedObstacles::note_in_view(const EvidenceMap& map, const PointsInMap& in_map, std::size_t count) noexcept {
  for (std::size_t k = 0; k < count; ++k) {
    (void)all_about(map.cell_at(in_map.position[k]), [&](CellIndex cell) {
      if (map.contains(cell)) marks_[map.slot(cell)] = kInView;
      return true;
    });
  }
}

/// False where the cell is in view, of what stays, or farther from the first than bodies are wide.
bool IsolatedObstacles::take(const EvidenceMap& map, CellIndex cell) noexcept {
  std::uint8_t& mark = marks_[map.slot(cell)];
  if (mark == kGathered) return true;
  if (mark != kNew || !gathered_.push_back(cell)) return false;
  mark = kGathered;
  const std::int32_t off = std::max(std::abs(cell.i - gathered_[0].i), std::abs(cell.j - gathered_[0].j));
  return off * map.cell_m() < kWidestBodyM;
}

/// All that hangs together with `first`; false where that stays.
bool IsolatedObstacles::gather(const EvidenceMap& map, CellIndex first) noexcept {
  gathered_.clear();
  bool loose = take(map, first);
  for (std::size_t k = 0; loose && k < gathered_.size(); ++k) {
    loose = all_about(gathered_[k], [&](CellIndex cell) { return !map.occupied(cell) || take(map, cell); });
  }
  for (const CellIndex cell : gathered_) marks_[map.slot(cell)] = kStays;
  return loose;
}

void IsolatedObstacles::forget_unseen(EvidenceMap& map) noexcept {
  const CellIndex low = map.low();
  for (std::int32_t j = low.j; j < low.j + map.side(); ++j) {
    for (std::int32_t i = low.i; i < low.i + map.side(); ++i) {
      if (!map.occupied({i, j}) || marks_[map.slot({i, j})] != kNew || !gather(map, {i, j})) continue;
      for (const CellIndex cell : gathered_) map.forget(cell);
    }
  }
  std::fill(marks_.begin(), marks_.end(), kNew);
}

}  // namespace jaywalk
