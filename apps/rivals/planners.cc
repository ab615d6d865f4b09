#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "apps/rivals/baseline.h"
#include "hal/types/fixed_vector.h"

namespace jaywalk::baseline {
namespace {

constexpr int kSide = 61;        ///< cells; the robot is in the middle
constexpr float kCell_m = 0.2F;  ///< 12 m across: beyond, walls alone count
constexpr int kMostRounds = 12;  ///< of four sweeps
constexpr float kBlocked_s = 2.0F * Guide::kNoWay_s;
constexpr float kDiagonal = 1.41421356F;

/// Times to the goal, past walls and past where every mover is.
class LocalField {
 public:
  explicit LocalField(const Scene& scene) : scene_(scene) {
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i) at(i, j) = is_blocked(x_of(i), y_of(j)) ? kBlocked_s : begin_at(i, j);
    at(kSide / 2, kSide / 2) = Guide::kNoWay_s;  // where the robot is, it may be
    for (int round = 0; round < kMostRounds && sweep(); ++round) {
    }
  }

  /// Half a metre down the field from the robot; false where there is no way.
  [[nodiscard]] bool next(cell::Heading& direction) const {
    int i = kSide / 2, j = kSide / 2;
    for (int step = 0; step < 3; ++step) {
      int best_i = i, best_j = j;
      for (int dj = -1; dj <= 1; ++dj) {
        for (int di = -1; di <= 1; ++di)
          if (time(i + di, j + dj) < time(best_i, best_j)) best_i = i + di, best_j = j + dj;
      }
      i = best_i, j = best_j;
    }
    const float dx = static_cast<float>(i - kSide / 2), dy = static_cast<float>(j - kSide / 2);
    const float size = std::sqrt(dx * dx + dy * dy);
    if (size > 0.0F) direction = {dx / size, dy / size};
    return size > 0.0F && time(i, j) < Guide::kNoWay_s;
  }

 private:
  float& at(int i, int j) { return times_[static_cast<std::size_t>(j * kSide + i)]; }
  [[nodiscard]] float time(int i, int j) const {
    const bool inside = i >= 0 && j >= 0 && i < kSide && j < kSide;
    return inside ? times_[static_cast<std::size_t>(j * kSide + i)] : kBlocked_s;
  }
  [[nodiscard]] float x_of(int i) const { return scene_.now.x + kCell_m * static_cast<float>(i - kSide / 2); }
  [[nodiscard]] float y_of(int j) const { return scene_.now.y + kCell_m * static_cast<float>(j - kSide / 2); }

  [[nodiscard]] bool is_blocked(float x, float y) const {
    if (scene_.guide.room(x, y) < scene_.radius) return true;
    return std::any_of(scene_.tracks.begin(), scene_.tracks.end(), [&](const Track& track) {
      const float radius = scene_.radius + static_cast<float>(track.radius_m) + kMargin_m;
      return offset_to(track, x, y).squaredNorm() < radius * radius;
    });
  }
  /// At the rim, and at the goal, the way is the one past walls alone.
  [[nodiscard]] float begin_at(int i, int j) const {
    const float dx = scene_.goal.x - x_of(i), dy = scene_.goal.y - y_of(j);
    if (dx * dx + dy * dy < kCell_m * kCell_m) return 0.0F;
    const bool rim = i == 0 || j == 0 || i == kSide - 1 || j == kSide - 1;
    return rim ? std::min(scene_.guide.time_to_go(x_of(i), y_of(j)), Guide::kNoWay_s) : Guide::kNoWay_s;
  }
  bool settle(int i, int j) {
    float& here = at(i, j);
    if (here >= kBlocked_s) return false;
    const float step = kCell_m / scene_.bounds.speed;
    float least = here;
    for (int dj = -1; dj <= 1; ++dj) {
      for (int di = -1; di <= 1; ++di) {
        const float over = time(i + di, j + dj) + step * (di != 0 && dj != 0 ? kDiagonal : 1.0F);
        if (di != 0 || dj != 0) least = std::min(least, over);
      }
    }
    return least < here ? here = least, true : false;
  }
  /// In four orders; whether anything changed.
  bool sweep() {
    bool changed = false;
    for (int order = 0; order < 4; ++order) {
      for (int b = 0; b < kSide; ++b)
        for (int a = 0; a < kSide; ++a)
          changed |= settle((order & 1) != 0 ? kSide - 1 - a : a, (order & 2) != 0 ? kSide - 1 - b : b);
    }
    return changed;
  }

  const Scene& scene_;
  std::array<float, static_cast<std::size_t>(kSide* kSide)> times_{};
};

constexpr float kWindow_s = 0.25F;                    ///< velocities that are reached within
constexpr float kStep_s = 0.1F, kHorizon_s = 3.0F;    ///< of an arc
constexpr int kWindowSpeeds = 11, kWindowTurns = 21;  ///< of the window
constexpr float kProgress = 0.6F, kHeading = 0.2F, kClearance = 0.1F, kVelocity = 0.1F;  ///< weights, of 1 in all
constexpr float kFar_m = 1.5F;                                                           ///< clearance that is enough

/// From the robot's circle to the nearest wall or to the nearest track where it is now.
float clearance(const Scene& scene, float x, float y) noexcept {
  float least = scene.guide.room(x, y);
  for (const Track& track : scene.tracks)
    least = std::min(least, offset_to(track, x, y).norm() - static_cast<float>(track.radius_m));
  return least - scene.radius - kMargin_m;
}

struct Arc {
  float free_m = 0.0F;  ///< of way before something is touched
  float clear_m = kFar_m;
  motion::RobotState end;
};

Arc arc_of(const Scene& scene, const motion::Command& to) noexcept {
  Arc arc{0.0F, kFar_m, scene.now};
  for (float t = 0.0F; t < kHorizon_s; t += kStep_s) {
    arc.end.heading += to.w * kStep_s;
    const cell::Heading at = cell::heading_at(arc.end.heading);
    arc.end.x += to.v * kStep_s * at.x, arc.end.y += to.v * kStep_s * at.y;
    const float clear = clearance(scene, arc.end.x, arc.end.y);
    if (clear < 0.0F) return arc.clear_m = 0.0F, arc;
    arc.clear_m = std::min(arc.clear_m, clear);
    arc.free_m += to.v * kStep_s;
  }
  arc.free_m = 1e3F;
  return arc;
}

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
  FixedVector<HalfPlane, kMaxTracks + kWalls> planes{};
  float speed = 0.0F;

  void add(const HalfPlane& plane) { static_cast<void>(planes.push_back(plane)); }
  [[nodiscard]] float least_room(const Velocity& v) const {
    float least = speed - v.norm();
    for (const HalfPlane& plane : planes) least = std::min(least, plane.room(v));
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
  for (const HalfPlane& edge : constraints.planes) {
    const Velocity foot = preferred - edge.room(preferred) * edge.outward;
    const Velocity along{-edge.outward.y(), edge.outward.x()};
    consider(foot);
    const float b = foot.dot(along), c = foot.squaredNorm() - constraints.speed * constraints.speed;
    if (!(b * b < c))  // the edge meets the circle of the highest speed
      for (const float root : {std::sqrt(b * b - c), -std::sqrt(b * b - c)}) consider(foot + (-b + root) * along);
    for (const HalfPlane& other : std::span(constraints.planes.begin(), &edge)) {
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

motion::Command replan(const Scene& scene) noexcept {
  cell::Heading direction;
  if (!LocalField(scene).next(direction)) return {};  // enclosed: wait
  return driven_along(scene, direction, speed_to_goal(scene));
}

motion::Command dwa(const Scene& scene) noexcept {
  const motion::MotionBounds& b = scene.bounds;
  const float low_v = std::max(0.0F, scene.now.v - b.slowing * kWindow_s),
              high_v = std::min({b.speed, scene.now.v + b.accel * kWindow_s, speed_to_goal(scene)});
  const float low_w = std::max(-b.turn, scene.now.w - b.turn_accel * kWindow_s),
              high_w = std::min(b.turn, scene.now.w + b.turn_accel * kWindow_s);
  const float here_s = scene.guide.time_to_go(scene.now.x, scene.now.y);
  const motion::Command turn = driven_along(scene, way_down(scene), 0.0F);
  motion::Command best{0.0F, turn.w};  // where nothing is admissible: turn to the way
  float most = -1e9F;
  for (int i = 0; i < kWindowSpeeds; ++i) {
    for (int j = 0; j < kWindowTurns; ++j) {
      const motion::Command to{low_v + (high_v - low_v) * static_cast<float>(i) / (kWindowSpeeds - 1),
                               low_w + (high_w - low_w) * static_cast<float>(j) / (kWindowTurns - 1)};
      const Arc arc = arc_of(scene, to);
      if (to.v > 0.0F && to.v * to.v > b.slowing * arc.free_m) continue;  // half the braking: the ramp takes the rest
      const float gained_s = here_s - scene.guide.time_to_go(arc.end.x, arc.end.y);
      const cell::Heading down = way_down({arc.end, scene.goal, {}, scene.guide, b, scene.radius});
      const cell::Heading at = cell::heading_at(arc.end.heading);
      const float worth = kProgress * std::clamp(gained_s / kHorizon_s, -1.0F, 1.0F) +
                          kHeading * (down.x * at.x + down.y * at.y) + kClearance * arc.clear_m / kFar_m +
                          kVelocity * to.v / b.speed;
      if (worth > most) most = worth, best = to;
    }
  }
  return best;
}

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
