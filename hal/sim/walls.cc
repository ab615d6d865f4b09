#include "hal/sim/walls.h"

#include <algorithm>
#include <cmath>

namespace jaywalk::sim {
namespace {

constexpr double kFinestBucket = 0.5;       // m: measured best of 0.25, 0.5 and 1 on the project's maps
constexpr double kMostBucketsASide = 2000;  // larger worlds get larger buckets

Box2 box_of(const WallSegment& s) {
  Box2 box{s.from, s.from};
  box.hold(s.to);
  return box;
}
Box2 box_of(const Disc& d) {
  const Vec2 r{d.radius_m, d.radius_m};
  return {d.centre - r, d.centre + r};
}

Box2 box_round(const WallMap& map) {
  Box2 all;
  const auto hold = [&all](const Box2& box) { all.hold(box.low), all.hold(box.high); };
  for (const WallSegment& s : map.segments) hold(box_of(s));
  for (const Disc& d : map.discs) hold(box_of(d));
  return all.is_empty() ? Box2{{}, {}} : all;
}

double surface_distance(Vec2 p, const WallSegment& segment) { return distance(p, segment); }
double surface_distance(Vec2 p, const Disc& disc) { return distance(p, disc.centre) - disc.radius_m; }

/// One axis of a walk through buckets (Amanatides and Woo, 1987): the range at which the ray leaves the present
/// bucket, how much each next one adds, and which way it goes.
struct Axis {
  double leaves_at, per_bucket;
  std::int32_t step, index;
};

Axis axis_of(double from, double slope, double low, double bucket_m, std::int32_t count) {
  const double place = (from - low) / bucket_m;
  const double index = std::clamp(std::floor(place), 0.0, static_cast<double>(count - 1));
  if (slope == 0.0) return {kInfinity, kInfinity, 0, static_cast<std::int32_t>(index)};
  const double edge = slope > 0.0 ? index + 1.0 : index;
  return {(edge - place) * bucket_m / slope, bucket_m / std::fabs(slope), slope > 0.0 ? 1 : -1,
          static_cast<std::int32_t>(index)};
}

/// Range at which a ray enters the box, 0 from inside; infinity when it misses.
double enters_at(const Box2& box, Vec2 from, Vec2 direction) {
  double begin = 0.0, end = kInfinity;
  const auto narrow = [&](double p, double slope, double low, double high) {
    if (slope == 0.0) {
      if (p < low || p > high) end = -1.0;
      return;
    }
    const double a = (low - p) / slope, b = (high - p) / slope;
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  };
  narrow(from.x, direction.x, box.low.x, box.high.x);
  narrow(from.y, direction.y, box.low.y, box.high.y);
  return begin <= end ? begin : kInfinity;
}

/// Footprint and wall in the robot's own frame, where the footprint is a box.
struct BodyFrame {
  const Footprint& footprint;
  Transform2 robot_from_map;
  Box2 body{{-footprint.rear_m, -footprint.half_width_m}, {footprint.front_m, footprint.half_width_m}};

  [[nodiscard]] double distance_to(const WallSegment& s) const {
    const WallSegment wall{robot_from_map * s.from, robot_from_map * s.to};
    const Vec2 along = wall.to - wall.from;
    if (enters_at(body, wall.from, along) <= 1.0) return 0.0;  // ranges count the segment's own length here
    double nearest = std::min(footprint.distance_to(wall.from), footprint.distance_to(wall.to));
    for (const Vec2 corner : {body.low, Vec2{body.low.x, body.high.y}, body.high, Vec2{body.high.x, body.low.y}})
      nearest = std::min(nearest, distance(corner, wall));
    return nearest;
  }
  [[nodiscard]] double distance_to(const Disc& disc) const {
    return std::max(footprint.distance_to(robot_from_map * disc.centre) - disc.radius_m, 0.0);
  }
};

}  // namespace

Walls::Walls(WallMap map)
    : map_(std::move(map)), raster_from_map_(inverse(map_.raster.map_from_raster)), bounds_(box_round(map_)) {
  size_buckets();
  fill_buckets();
}

void Walls::size_buckets() {
  const Vec2 size = bounds_.high - bounds_.low;
  bucket_m_ = std::max(kFinestBucket, std::max(size.x, size.y) / kMostBucketsASide);
  columns_ = static_cast<std::int32_t>(size.x / bucket_m_) + 1;
  rows_ = static_cast<std::int32_t>(size.y / bucket_m_) + 1;
}

/// Counts, then places: the items of one bucket lie side by side. An item belongs to every bucket that it may touch.
void Walls::fill_buckets() {
  const double half_diagonal = bucket_m_ * 0.70710678118654757;
  const auto each_touch = [&](auto&& touch) {
    const auto scan = [&](const auto& shape, std::uint32_t item) {
      const Box2 box = box_of(shape);
      const Vec2 centre = (box.low + box.high) * 0.5, half = (box.high - box.low) * 0.5;
      const Span columns = overlap(centre.x, half.x, bounds_.low.x, columns_);
      const Span rows = overlap(centre.y, half.y, bounds_.low.y, rows_);
      for (std::int32_t row = rows.begin; row < rows.end; ++row) {
        for (std::int32_t column = columns.begin; column < columns.end; ++column) {
          const std::int32_t bucket = row * columns_ + column;
          if (surface_distance(bucket_centre(bucket), shape) <= half_diagonal)
            touch(static_cast<std::size_t>(bucket), item);
        }
      }
    };
    std::uint32_t item = 0;
    for (const WallSegment& s : map_.segments) scan(s, item++);
    for (const Disc& d : map_.discs) scan(d, item++);
  };
  first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
  each_touch([&](std::size_t bucket, std::uint32_t) { ++first_[bucket + 1]; });
  for (std::size_t b = 1; b < first_.size(); ++b) first_[b] += first_[b - 1];
  items_.resize(first_.back());
  std::vector<std::uint32_t> next(first_);
  each_touch([&](std::size_t bucket, std::uint32_t item) { items_[next[bucket]++] = item; });
}

Walls::Span Walls::overlap(double centre, double reach, double low, std::int32_t count) const noexcept {
  const auto index = [&](double p) {
    return static_cast<std::int32_t>(std::clamp(std::floor((p - low) / bucket_m_), -1.0, static_cast<double>(count)));
  };
  return {std::max(index(centre - reach), 0), std::min(index(centre + reach) + 1, count)};
}

double Walls::cast(Vec2 from, Vec2 direction, double max_range) const noexcept {
  const double entry = enters_at(bounds_, from, direction);
  if (!(entry <= max_range)) return kInfinity;
  const Vec2 start = from + direction * entry;
  Axis x = axis_of(start.x, direction.x, bounds_.low.x, bucket_m_, columns_);
  Axis y = axis_of(start.y, direction.y, bounds_.low.y, bucket_m_, rows_);
  double nearest = kInfinity;
  const auto meet = [&](const auto& shape) { nearest = std::min(nearest, hit_range(from, direction, shape)); };
  double leaves_at = entry;  // the bucket before; a wall met before the bucket's end is the first on the way
  while (leaves_at < std::min(nearest, max_range) && x.index >= 0 && x.index < columns_ && y.index >= 0 &&
         y.index < rows_) {
    visit_bucket(y.index * columns_ + x.index, meet);
    Axis& next = x.leaves_at < y.leaves_at ? x : y;
    leaves_at = entry + next.leaves_at;
    next.leaves_at += next.per_bucket;
    next.index += next.step;
  }
  return nearest <= max_range ? nearest : kInfinity;
}

bool Walls::solid_at(Vec2 p) const noexcept {
  const Raster& raster = map_.raster;
  if (raster.solid.empty()) return false;
  const Vec2 in_raster = raster_from_map_ * p;
  const double column = std::floor(in_raster.x / raster.cell_m), row = std::floor(in_raster.y / raster.cell_m);
  if (!(column >= 0.0 && row >= 0.0 && column < raster.width && row < raster.height)) return false;
  return raster.solid_cell(static_cast<std::int32_t>(column), static_cast<std::int32_t>(row));
}

double Walls::distance(Vec2 p, double cap) const noexcept {
  if (solid_at(p)) return 0.0;
  double nearest = cap;
  for_each_near(p, cap, [&](const auto& shape) { nearest = std::min(nearest, surface_distance(p, shape)); });
  return std::max(nearest, 0.0);
}

double Walls::clearance(const Footprint& footprint, const Pose2& map_from_robot) const noexcept {
  if (solid_at(map_from_robot.position())) return 0.0;
  const double body = footprint.circumscribed_radius_m();
  const Vec2 size = bounds_.high - bounds_.low;
  const Vec2 to_middle = (bounds_.low + bounds_.high) * 0.5 - map_from_robot.position();
  const double everything = norm(to_middle) + norm(size) + body;
  const BodyFrame frame{footprint, Transform2(inverse(map_from_robot))};
  for (double reach = body + 0.5;; reach *= 2.0) {  // all within reach - body of the footprint has been seen
    double nearest = kInfinity;
    for_each_near(map_from_robot.position(), reach,
                  [&](const auto& shape) { nearest = std::min(nearest, frame.distance_to(shape)); });
    if (nearest <= reach - body || reach > everything) return nearest;
  }
}

}  // namespace jaywalk::sim
