#pragma once
// Points, poses and twists in the plane. SI units, x forward, y left, angles in radians. A Pose2 map_from_robot takes
// points in the robot's frame to the map's; map_from_robot * robot_from_laser is map_from_laser.
#include <algorithm>
#include <cmath>
#include <limits>

#include "hal/types/trig.h"

namespace jaywalk {

struct Vec2 {
  double x = 0.0;
  double y = 0.0;

  constexpr Vec2 operator+(Vec2 o) const { return {x + o.x, y + o.y}; }
  constexpr Vec2 operator-(Vec2 o) const { return {x - o.x, y - o.y}; }
  constexpr Vec2 operator*(double s) const { return {x * s, y * s}; }
  constexpr bool operator==(const Vec2&) const = default;
};

[[nodiscard]] constexpr double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
/// z component of a x b: positive when b lies to the left of a.
[[nodiscard]] constexpr double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
[[nodiscard]] inline double norm(Vec2 v) { return std::sqrt(dot(v, v)); }
[[nodiscard]] inline double distance(Vec2 a, Vec2 b) { return norm(b - a); }
/// Unit vector at `heading` radians from +x.
[[nodiscard]] inline Vec2 direction(double heading) { return {cos(heading), sin(heading)}; }

/// Nearest point of the segment between two points.
[[nodiscard]] inline Vec2 nearest_on_segment(Vec2 p, Vec2 from, Vec2 to) {
  const Vec2 along = to - from;
  const double squared = dot(along, along);
  const double share = squared > 0.0 ? std::clamp(dot(p - from, along) / squared, 0.0, 1.0) : 0.0;
  return from + along * share;
}

/// Upright rectangle; at first one that holds nothing, its low corner beyond the high one.
struct Box2 {
  static constexpr double kBeyond = std::numeric_limits<double>::infinity();
  Vec2 low{kBeyond, kBeyond}, high{-kBeyond, -kBeyond};

  [[nodiscard]] bool is_empty() const { return !(low.x <= high.x); }
  /// Grows until it holds the point.
  void hold(Vec2 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
};

/// Position and heading (rad, in (-pi, pi]) of one frame in another.
struct Pose2 {
  double x = 0.0;
  double y = 0.0;
  double heading = 0.0;

  [[nodiscard]] constexpr Vec2 position() const { return {x, y}; }
  constexpr bool operator==(const Pose2&) const = default;
};

/// A pose with its sine and cosine at hand: for taking many points from one frame to another.
class Transform2 {
 public:
  explicit Transform2(const Pose2& pose) : origin_(pose.position()), axis_(direction(pose.heading)) {}
  [[nodiscard]] Vec2 rotate(Vec2 v) const { return {axis_.x * v.x - axis_.y * v.y, axis_.y * v.x + axis_.x * v.y}; }
  [[nodiscard]] Vec2 operator*(Vec2 p) const { return origin_ + rotate(p); }

 private:
  Vec2 origin_;
  Vec2 axis_;
};

[[nodiscard]] inline Vec2 operator*(const Pose2& a_from_b, Vec2 p_in_b) { return Transform2(a_from_b) * p_in_b; }
[[nodiscard]] inline Pose2 operator*(const Pose2& a_from_b, const Pose2& b_from_c) {
  const Vec2 origin = a_from_b * b_from_c.position();
  return {origin.x, origin.y, wrap_angle(a_from_b.heading + b_from_c.heading)};
}
[[nodiscard]] inline bool finite(const Pose2& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.heading);
}
/// b_from_a, given a_from_b.
[[nodiscard]] inline Pose2 inverse(const Pose2& a_from_b) {
  const Vec2 u = direction(a_from_b.heading);
  const Vec2 p = a_from_b.position();
  return {-dot(u, p), -cross(u, p), wrap_angle(-a_from_b.heading)};
}

/// Velocity of a differential drive in its own frame: forward (m/s) and counter-clockwise (rad/s).
struct Twist2 {
  double v_mps = 0.0;
  double w_radps = 0.0;
  constexpr bool operator==(const Twist2&) const = default;
};

}  // namespace jaywalk
