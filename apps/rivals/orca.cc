#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "apps/rivals/baseline.h"

namespace jaywalk::baseline {
namespace {

constexpr float kTau_s = 2.5F;          ///< tau, of movers
constexpr float kWallHorizon_s = 1.0F;  ///< of walls
constexpr float kPartWithin_s = 0.07F;  ///< within which an overlap is to end: a scan's period
constexpr int kWalls = 16;
constexpr float kTolerance = 1e-4F;

using Velocity = Eigen::Vector2f;

/// Velocities v with (v - point) . outward >= 0 are allowed.
struct HalfPlane {
  Velocity point, outward;
  [[nodiscard]] float room(const Velocity& v) const { return (v - point).dot(outward); }
};

struct Constraints {
  std::array<HalfPlane, kMaxTracks + kWalls> planes{};
  std::size_t count = 0;
  float speed = 0.0F;

  void add(const HalfPlane& plane) { planes[count++] = plane; }
  [[nodiscard]] float least_room(const Velocity& v) const {
    float least = speed - v.norm();
    for (std::size_t k = 0; k < count; ++k) least = std::min(least, planes[k].room(v));
    return least;
  }
};

/// The smallest change u of the relative velocity that leaves the velocity obstacle, equations (3) to (5): the cone of
/// `apart` (m) with the disc of `radius` cut off at tau.
HalfPlane plane_of(const Velocity& apart, const Velocity& relative, float radius, const Velocity& own) noexcept {
  const float distance = apart.norm();
  const bool overlaps = distance < radius;
  const float horizon = overlaps ? kPartWithin_s : kTau_s;
  const Velocity from_centre = relative - (1.0F / horizon) * apart;  // of the cut-off disc
  const float along = from_centre.dot(apart), size = from_centre.norm();
  Velocity outward, change;
  if (overlaps || (along < 0.0F && along * along > radius * radius * from_centre.squaredNorm())) {
    outward = size > 1e-6F ? (1.0F / size) * from_centre : (-1.0F / std::max(distance, 1e-6F)) * apart;
    change = (radius / horizon - size) * outward;
  } else {  // on the legs
    const float leg = std::sqrt(std::max(distance * distance - radius * radius, 0.0F));
    const bool left = apart.x() * from_centre.y() - apart.y() * from_centre.x() > 0.0F;
    const float side = left ? 1.0F : -1.0F, squared = distance * distance;
    const Velocity direction{(apart.x() * leg - side * apart.y() * radius) / squared,
                             (side * apart.x() * radius + apart.y() * leg) / squared};
    change = relative.dot(direction) * direction - relative;
    outward = {-side * direction.y(), side * direction.x()};
  }
  return {own + change, outward};
}

void add_movers(const Scene& scene, const Velocity& own, Constraints& constraints) noexcept {
  for (const Track& track : scene.tracks.first(std::min(scene.tracks.size(), kMaxTracks))) {
    Velocity walks = Velocity::Zero();
    if (track.moving)
      walks = {static_cast<float>(track.velocity_in_map.x), static_cast<float>(track.velocity_in_map.y)};
    const float radius = scene.radius + static_cast<float>(track.radius_m) + kMargin_m;
    constraints.add(plane_of(offset_to(track, scene.now.x, scene.now.y), own - walks, radius, own));
  }
}

/// Free way to a wall in a direction, m.
float free_way(const Scene& scene, cell::Heading d) noexcept {
  float way = 0.0F;
  for (int k = 0; k < 12 && way < Guide::kFar_m; ++k) {
    const float left = scene.guide.distance(scene.now.x + way * d.x, scene.now.y + way * d.y);
    if (left < 0.03F) break;
    way += left;
  }
  return way;
}

/// Walls take no part in giving way: so fast that the circle reaches none within their tau.
void add_walls(const Scene& scene, Constraints& constraints) noexcept {
  for (int k = 0; k < kWalls; ++k) {
    const cell::Heading d = cell::heading_at(2.0F * cell::kPiF * static_cast<float>(k) / kWalls);
    const float most = std::max(0.0F, free_way(scene, d) - scene.radius) / kWallHorizon_s;
    constraints.add({{most * d.x, most * d.y}, {-d.x, -d.y}});
  }
}

/// The allowed velocity nearest to the preferred: the preferred, its foot on an edge, or a corner; none: nothing is
/// allowed.
std::optional<Velocity> nearest(const Constraints& constraints, const Velocity& preferred) noexcept {
  std::optional<Velocity> best;
  const auto consider = [&](const Velocity& v) {
    if (best && (v - preferred).norm() >= (*best - preferred).norm()) return;
    if (!(constraints.least_room(v) < -kTolerance)) best = v;
  };
  consider(preferred);
  for (std::size_t i = 0; i < constraints.count; ++i) {
    const HalfPlane& edge = constraints.planes[i];
    const Velocity foot = preferred - edge.room(preferred) * edge.outward;
    const Velocity along{-edge.outward.y(), edge.outward.x()};
    consider(foot);
    const float b = foot.dot(along), c = foot.squaredNorm() - constraints.speed * constraints.speed;
    if (!(b * b < c))  // the edge meets the circle of the highest speed
      for (const float root : {std::sqrt(b * b - c), -std::sqrt(b * b - c)}) consider(foot + (-b + root) * along);
    for (const HalfPlane& other : std::span(constraints.planes).first(i)) {
      const float slope = along.dot(other.outward);
      if (std::fabs(slope) > 1e-5F) consider(foot - (other.room(foot) / slope) * along);
    }
  }
  return best;
}

/// Where nothing is allowed: the velocity that breaks the worst constraint least (their third linear programme), of a
/// grid of directions and speeds.
Velocity least_bad(const Constraints& constraints) noexcept {
  constexpr int kDirections = 32, kSpeeds = 6;
  Velocity best = Velocity::Zero();
  float most = constraints.least_room(best);
  for (int i = 0; i < kDirections; ++i) {
    const cell::Heading d = cell::heading_at(2.0F * cell::kPiF * static_cast<float>(i) / kDirections);
    for (int j = 1; j <= kSpeeds; ++j) {
      const float speed = constraints.speed * static_cast<float>(j) / kSpeeds;
      const Velocity v{speed * d.x, speed * d.y};
      const float room = constraints.least_room(v);
      if (room > most) most = room, best = v;
    }
  }
  return best;
}

}  // namespace

motion::Command orca(const Scene& scene) noexcept {
  const cell::Heading ahead = cell::heading_at(scene.now.heading), down = way_down(scene);
  const Velocity own{scene.now.v * ahead.x, scene.now.v * ahead.y};
  const float speed = speed_to_goal(scene);
  Constraints constraints;
  constraints.speed = scene.bounds.speed;
  add_movers(scene, own, constraints);
  add_walls(scene, constraints);
  const auto allowed = nearest(constraints, {speed * down.x, speed * down.y});
  const Velocity chosen = allowed ? *allowed : least_bad(constraints);
  const float size = chosen.norm();
  if (size < 0.01F) return {0.0F, driven_along(scene, down, 0.0F).w};
  return driven_along(scene, {chosen.x() / size, chosen.y() / size}, size);
}

}  // namespace jaywalk::baseline
