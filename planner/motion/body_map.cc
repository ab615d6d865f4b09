#include "planner/motion/body_map.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {
namespace {

constexpr double kPitch_m = 0.1;      // between samples of an outline
constexpr double kMayStop_mps = 0.3;  // a pedestrian that turns about or comes to stand is slower; by trial
                                      // (docs/explanation/decisions/long-bodies.md)
constexpr double kCoat_m = 0.05;      // inflates standing pedestrians, which may be wider than they are taken for
constexpr double kStoodOn_m = 0.03;   // the least that a wall may be off unseen
constexpr double kGraze_m = 0.05;     // surfaces are known to so much: less deep is on the outline

/// Points from `a` towards `b`, evenly spaced, without `b`.
void sample_edge(Vec2 a, Vec2 b, std::vector<Vec2>& points) {
  const double pieces = std::ceil(distance(a, b) / kPitch_m);
  for (double k = 0.0; k < pieces; k += 1.0) points.push_back(a + (b - a) * (k / pieces));
}

}  // namespace

BodyMap::BodyMap(const Footprint& footprint)
    : footprint_(footprint),
      distance_(static_cast<std::size_t>(kSide * kSide), static_cast<float>(kFar_m)),
      unseen_(static_cast<std::size_t>(kPatches * kPatches)) {
  // The front first: it is what meets things most often, and the looking ends there.
  const std::array<Vec2, 4> corners{{{footprint.front_m, -footprint.half_width_m},
                                     {footprint.front_m, footprint.half_width_m},
                                     {-footprint.rear_m, footprint.half_width_m},
                                     {-footprint.rear_m, -footprint.half_width_m}}};
  for (std::size_t k = 0; k < corners.size(); ++k) sample_edge(corners[k], corners[(k + 1) % 4], outline_);
  const double length = footprint.front_m + footprint.rear_m;
  inside_m_ = std::min({footprint.half_width_m, 0.5 * length, kFar_m});
  const double last = length - 2.0 * inside_m_, gaps = std::ceil(last / inside_m_);
  for (double k = 0.0; k <= gaps; k += 1.0)
    spine_.push_back(inside_m_ - footprint.rear_m + last * k / std::max(gaps, 1.0));
}

void BodyMap::draw(const EvidenceMap& still, const Pose2& map_from_robot, std::span<const StandingPedestrian> standing,
                   std::span<const Track> moving, const KeepOut& keep_out,
                   std::span<const Vec2> unseen_walls) noexcept {
  const Vec2 centre = map_from_robot.position();
  std::fill(distance_.begin(), distance_.end(), static_cast<float>(kFar_m * kFar_m));
  low_ = centre - Vec2{kReach_m, kReach_m};
  robot_from_map_ = inverse(map_from_robot);
  const double reach_m = kReach_m + kFar_m;
  const CellIndex first = still.cell_at(centre - Vec2{reach_m, reach_m});
  const CellIndex last = still.cell_at(centre + Vec2{reach_m, reach_m});
  for (std::int32_t j = first.j; j <= last.j; ++j) {
    for (std::int32_t i = first.i; i <= last.i; ++i) {
      if (!still.occupied({i, j})) continue;
      const Vec2 here = still.surface({i, j});
      stamp(here);
      // Half-way to its neighbours too: a surface has a point a cell, and an outline could seem clear of it between
      // them.
      for (const CellIndex beside : {CellIndex{i + 1, j}, {i, j + 1}, {i + 1, j + 1}, {i - 1, j + 1}}) {
        if (still.occupied(beside)) stamp((here + still.surface(beside)) * 0.5);
      }
    }
  }
  for (const StandingPedestrian& stander : standing) stamp_round(stander.position_in_map, stander.radius_m + kCoat_m);
  for (const Track& track : moving) {
    if (norm(track.velocity_in_map) < kMayStop_mps) stamp_round(track.position_in_map, track.radius_m + kCoat_m);
  }
  const bool is_in_one = keep_out.distance(static_cast<float>(centre.x), static_cast<float>(centre.y)) < 0.0F;
  if (keep_out.known() && !is_in_one) stamp_zones(keep_out);
  for (const Vec2 wall : unseen_walls) {
    const Vec2 here = map_from_robot * wall;
    if (!still.seen_free(still.cell_at(here))) stamp(here);
  }
  note_unseen(still);
  for (float& d : distance_) d = std::sqrt(d);
}

void BodyMap::note_unseen(const EvidenceMap& still) noexcept {
  for (std::int32_t j = 0; j < kPatches; ++j) {
    for (std::int32_t i = 0; i < kPatches; ++i) {
      const Vec2 p = low_ + Vec2{(i + 0.5) * kPatch_m, (j + 0.5) * kPatch_m};
      const CellIndex cell = still.cell_at(p);
      const bool seen = still.seen_free(cell) || still.occupied(cell);
      unseen_[static_cast<std::size_t>(j * kPatches + i)] = seen ? 0 : 1;
    }
  }
}

bool BodyMap::goes_unseen(Vec2 position, Vec2 ahead, Part part) const noexcept {
  const Transform2 robot_from_map(robot_from_map_);
  for (const Vec2 p : outline_) {
    if (part == Part::kBehindAxle && p.x > 0.0) continue;
    const Vec2 on_map = position + Vec2{ahead.x * p.x - ahead.y * p.y, ahead.y * p.x + ahead.x * p.y};
    if (!covers(on_map)) continue;
    const Vec2 at = (on_map - low_) * (1.0 / kPatch_m);
    const std::int32_t patch = static_cast<std::int32_t>(at.y) * kPatches + static_cast<std::int32_t>(at.x);
    const bool seen = unseen_[static_cast<std::size_t>(patch)] == 0;
    if (!seen && footprint_.distance_to(robot_from_map * on_map) > kStoodOn_m) return true;
  }
  return false;
}

/// Squared distances of the nodes within kFar_m of a surface, where it is the nearest so far.
void BodyMap::stamp(Vec2 surface) noexcept {
  const auto x = static_cast<float>((surface.x - low_.x) / kNode_m);
  const auto y = static_cast<float>((surface.y - low_.y) / kNode_m);
  constexpr auto kReachNodes = static_cast<float>(kFar_m / kNode_m);
  constexpr auto kLast = static_cast<float>(kSide - 1);
  constexpr auto kSquare = static_cast<float>(kNode_m * kNode_m);
  const auto node = [&](float at) { return static_cast<std::int32_t>(std::clamp(at, 0.0F, kLast)); };
  if (x < -kReachNodes || y < -kReachNodes || x > kLast + kReachNodes || y > kLast + kReachNodes) return;
  for (std::int32_t j = node(y - kReachNodes); j <= node(y + kReachNodes); ++j) {
    const float dy = static_cast<float>(j) - y;
    float* row = distance_.data() + j * kSide;
    for (std::int32_t i = node(x - kReachNodes); i <= node(x + kReachNodes); ++i) {
      const float dx = static_cast<float>(i) - x;
      row[i] = std::min(row[i], (dx * dx + dy * dy) * kSquare);
    }
  }
}

void BodyMap::stamp_zones(const KeepOut& keep_out) noexcept {
  for (std::int32_t j = 0; j < kSide; ++j) {
    for (std::int32_t i = 0; i < kSide; ++i) {
      const Vec2 p = low_ + Vec2{i * kNode_m, j * kNode_m};
      const float d = std::max(keep_out.distance(static_cast<float>(p.x), static_cast<float>(p.y)), 0.0F);
      float& least = distance_[static_cast<std::size_t>(j * kSide + i)];
      least = std::min(least, d * d);
    }
  }
}

void BodyMap::stamp_round(Vec2 centre, double radius_m) noexcept {
  const double points = std::ceil(2.0 * kPi * radius_m / kPitch_m);
  for (double k = 0.0; k < points; k += 1.0) {
    stamp(centre + direction(2.0 * kPi * k / points) * radius_m);
  }
}

bool BodyMap::covers(Vec2 p) const noexcept {
  const Vec2 at = (p - low_) * (1.0 / kNode_m);
  return at.x >= 0.0 && at.y >= 0.0 && at.x < kSide - 1 && at.y < kSide - 1;
}

double BodyMap::distance_at(Vec2 p) const noexcept {
  if (!covers(p)) return kFar_m;
  const Vec2 at = (p - low_) * (1.0 / kNode_m);
  const auto i = static_cast<std::int32_t>(at.x), j = static_cast<std::int32_t>(at.y);
  const double u = at.x - i, v = at.y - j;
  const float* node = distance_.data() + j * kSide + i;
  const auto of = [&](std::int32_t offset) { return static_cast<double>(node[offset]); };
  return (1.0 - v) * ((1.0 - u) * of(0) + u * of(1)) + v * ((1.0 - u) * of(kSide) + u * of(kSide + 1));
}

double BodyMap::clearance(Vec2 position, Vec2 ahead, double least_m) const noexcept {
  double nearest = kFar_m;
  for (const double x : spine_) {
    const double depth = inside_m_ - distance_at(position + ahead * x);
    if (depth > kGraze_m) nearest = std::min(nearest, -depth);
  }
  if (nearest < least_m) return nearest;
  for (const Vec2 p : outline_) {
    const Vec2 sample = position + Vec2{ahead.x * p.x - ahead.y * p.y, ahead.y * p.x + ahead.x * p.y};
    nearest = std::min(nearest, distance_at(sample));
    if (nearest < least_m) break;
  }
  return nearest;
}

}  // namespace jaywalk
