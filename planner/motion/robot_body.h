#pragma once
// The robot's body and bounds as roll-outs take them, and zones of slower speed.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "hal/types/map_zones.h"
#include "hal/types/robot_model.h"
#include "planner/cell/cell.h"
#include "planner/cost_to_go/guide.h"
#include "planner/motion/robot_motion.h"
#include "planner/motion/trajectory.h"

namespace jaywalk::motion {

/// Outline of a rectangular body, where covering discs say too little of how near it is to a surface: points every 8 cm
/// along it, corners among them, and the middles of the largest circles inside. A post between two points may be nearer
/// than said: by 2 cm where it is 3 cm away.
struct BodyOutline {
  static constexpr std::size_t kMostPoints = 96, kMostCircles = 8;
  static constexpr double kSpacing_m = 0.08;
  std::array<Place, kMostPoints> points{};  ///< in the robot's frame
  std::size_t point_count = 0;
  std::array<float, kMostCircles> ahead{};  ///< of circles' middles, m from the axle
  std::size_t circle_count = 0;
  float circle_m = 0.0F;

  /// Of a body of up to 7 m round about; beyond that the points are further apart.
  static BodyOutline of(const Footprint& body) {
    BodyOutline outline;
    const double front = body.front_m, rear = -body.rear_m, half = body.half_width_m, length = front - rear;
    const double pitch = std::max(kSpacing_m, 4.0 * (length + 2.0 * half) / static_cast<double>(kMostPoints));
    const std::array<Vec2, 5> corners{{{front, -half}, {front, half}, {rear, half}, {rear, -half}, {front, -half}}};
    for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
      const Vec2 side = corners[k + 1] - corners[k];
      const double pieces = std::ceil(norm(side) / pitch - 1e-9);
      for (double n = 0.0; n < pieces && outline.point_count < kMostPoints; n += 1.0) {
        const Vec2 p = corners[k] + side * (n / pieces);
        outline.points[outline.point_count++] = {static_cast<float>(p.x), static_cast<float>(p.y)};
      }
    }
    const double circle = std::min(half, 0.5 * length), row = length - 2.0 * circle;
    const double gaps = std::min(std::ceil(row / circle), static_cast<double>(kMostCircles - 1));
    outline.circle_m = static_cast<float>(circle);
    for (double k = 0.0; k <= gaps; k += 1.0)
      outline.ahead[outline.circle_count++] = static_cast<float>(rear + circle + row * k / std::max(gaps, 1.0));
    return outline;
  }

  /// From the body at (x, y), looking along `along`, to the nearest surface or keep-out zone, m; below 0 where one
  /// is inside.
  [[nodiscard]] JAYWALK_ANYWHERE float clearance(const Guide& guide, float x, float y,
                                                 const cell::Heading& along) const {
    float least = Guide::kFar_m;
    for (std::size_t k = 0; k < circle_count; ++k) {
      const float depth = circle_m - guide.room(x + ahead[k] * along.x, y + ahead[k] * along.y);
      if (depth > 0.0F && -depth < least) least = -depth;
    }
    for (std::size_t k = 0; k < point_count; ++k) {
      const Place p = points[k];
      const float d = guide.room(x + p.x * along.x - p.y * along.y, y + p.x * along.y + p.y * along.x);
      least = d < least ? d : least;
    }
    return least;
  }
};

/// Discs of one radius that cover a rectangular body, with their middles on its long axis. They reach beyond its sides
/// by what the constructor was told at most, so that what is clear of them is clear of the body.
struct BodyDiscs {
  static constexpr int kMost = 12;
  std::array<float, kMost> ahead{};  ///< of each middle, m from the axle
  float radius = 0.0F;
  int count = 0;

  /// As few discs as reach no more than `beyond_m` over the sides.
  static BodyDiscs covering(const Footprint& body, double beyond_m) {
    const double length = body.front_m + body.rear_m, w = body.half_width_m;
    BodyDiscs discs;
    for (discs.count = 1; discs.count < kMost; ++discs.count) {
      const double half = 0.5 * length / discs.count;
      if (std::sqrt(half * half + w * w) <= w + beyond_m) break;
    }
    const double half = 0.5 * length / discs.count;
    discs.radius = static_cast<float>(std::sqrt(half * half + w * w));
    for (int k = 0; k < discs.count; ++k) {
      discs.ahead[static_cast<std::size_t>(k)] = static_cast<float>(-body.rear_m + half * (2 * k + 1));
    }
    return discs;
  }

  /// From the body at (x, y), looking along `ahead_of`, to the nearest surface or keep-out zone, m; below 0 inside one.
  [[nodiscard]] JAYWALK_ANYWHERE float clearance(const Guide& guide, float x, float y,
                                                 const cell::Heading& along) const {
    float least = Guide::kFar_m;
    for (int k = 0; k < count; ++k) {
      const float s = ahead[static_cast<std::size_t>(k)];
      const float d = guide.room(x + s * along.x, y + s * along.y);
      least = d < least ? d : least;
    }
    return least - radius;
  }
};

/// The parts of the body's outline beside which no laser ever looks. The supervisor lets such a part move outward at
/// 0.3 m/s at most (firmware/safety/blind_gaps.cc); a roll-out that counts on more would be braked.
///
/// Memory in the constructor. Thread: any.
class BlindRim {
 public:
  BlindRim() = default;
  /// Beside points every 5 cm. Blanked sectors are left to the supervisor.
  BlindRim(const Footprint& footprint, const OfEach<LaserModel>& lasers);

  /// By how much (m/s) the fastest of them is too fast when the robot drives at `v` m/s and turns at `w` rad/s; 0 when
  /// none is.
  [[nodiscard]] float too_fast(float v, float w) const noexcept;
  /// The same way on, as fast as is permitted: both parts of the command in proportion, as the supervisor does it.
  [[nodiscard]] Command slowed(const Command& command) const noexcept;
  /// The same speed, with the turn as near to `w` as is permitted: while a ramped speed still falls, the turn waits for
  /// it, or the supervisor would brake both. `w` as it is where `v` alone is too fast.
  [[nodiscard]] float turn_at(float v, float w) const noexcept;
  /// Whether no laser looks at all that lies straight behind the robot.
  [[nodiscard]] bool is_behind() const noexcept { return too_fast(-1.0F, 0.0F) > 0.0F; }
  [[nodiscard]] std::size_t points() const noexcept { return points_.size(); }

 private:
  struct Point {
    float x, y;          ///< in the robot's frame
    float out_x, out_y;  ///< outward, both components at a corner
  };
  std::vector<Point> points_;
  float reach_m_ = 0.0F;  ///< of the farthest from the axle
};

/// How far the robot may back at its speed though nothing looks there: what it has driven forward, less what it has
/// backed since. At rest it shrinks by its greatest length a second: a pedestrian may step behind the robot. Beyond it
/// the robot backs slowly (docs/explanation/decisions/motion-backward.md).
class KnownBehind {
 public:
  KnownBehind() = default;
  explicit KnownBehind(bool is_blind) : is_blind_(is_blind) {}

  void drive(float v_mps, float for_s) noexcept {
    const float gained_mps = std::fabs(v_mps) < kRestsMps ? -kMost_m : v_mps;
    left_m_ = std::clamp(left_m_ + gained_mps * for_s, 0.0F, kMost_m);
  }

  [[nodiscard]] MotionBounds limited(MotionBounds bounds) const noexcept {
    if (is_blind_ && left_m_ <= 0.0F) bounds.back = std::min(bounds.back, kBeyondMps);
    return bounds;
  }

 private:
  static constexpr float kMost_m = 0.5F, kBeyondMps = 0.12F;
  bool is_blind_ = false;
  float left_m_ = 0.0F;
};

/// The robot, as roll-outs need it.
struct RobotBody {
  BodyDiscs to_walls, to_movers;
  BodyOutline outline;              ///< to walls, by a stick or near them: discs reach beyond a body's sides
  std::array<Place, 8> rim{};       ///< corners and the sides' middles, in the robot's frame
  float rim_m = 0.0F;               ///< farthest point from the axle
  float comfort_distance_m = 1.0F;  ///< from a disc's middle to a mover's: nearer costs
  BlindRim blind;                   ///< where the supervisor lets it go slowly
  MotionBounds bounds;

  /// Speed of the body's fastest point, m/s, about.
  [[nodiscard]] float rim_mps(const RobotState& r) const { return std::fabs(r.v) + std::fabs(r.w) * rim_m; }
  /// From the body's edge to a place in its frame, m; 0 inside.
  [[nodiscard]] JAYWALK_ANYWHERE float gap(float ahead, float left) const {
    const float front = rim[0].x, rear = rim[5].x, side = rim[0].y, off = std::fabs(left) - side;
    const float over = ahead > front ? ahead - front : ahead < rear ? rear - ahead : 0.0F;
    const float beside = off > 0.0F ? off : 0.0F;
    return std::sqrt(over * over + beside * beside);
  }
};

/// `comfort_distance_m`: a mover's middle nearer than this to the body's discs costs. Thread: any.
[[nodiscard]] RobotBody robot_body(const Footprint& footprint, const MotionLimits& limits,
                                   const OfEach<LaserModel>& lasers, double comfort_distance_m);

/// No faster than `most_mps` either way, nor than robot_body() has it.
void limit_speed_of(MotionBounds& bounds, const MotionLimits& limits, double most_mps) noexcept;

/// The fastest that speed zones let the robot drive, m/s; infinity where none says anything.
struct ZoneSpeed {
  double here_mps;   ///< now: the least of the zones that the circle about the body touches
  double ahead_mps;  ///< so that half of the comfortable deceleration slows down before the next zone begins
};

/// Of the zones of slower speed among `zones`.
[[nodiscard]] ZoneSpeed zone_speed(std::span<const MapZone> zones, const RobotModel& model, Vec2 robot_in_map) noexcept;

}  // namespace jaywalk::motion
